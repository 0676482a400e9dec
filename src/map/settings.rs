//! What maps of all kinds are told about their depths.

use super::bias::Bias;
use super::encoding::quantum;
use super::sides::CasterSides;
use crate::Radius;
use crate::error::MapSettingsError;

/// How depths of a [`CubeShadowMap`](crate::CubeShadowMap), a [`ShadowMap`](crate::ShadowMap) or a
/// [`ShadowAtlas`](crate::ShadowAtlas) are stored, drawn and compared. The default needs no tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// `Depth32Float` (default), `Depth24Plus` or `Depth16Unorm`. The last two round depths to one part in
    /// 2^24 and 2^16 of their range, and receivers are given one such step as bias: under a point light or a
    /// spot `d * d / (near * 65536)` at distance `d` in world units, under a directional light 1 / 65536 of the
    /// depth that its map or cascade covers, with [`LinearDistance`](crate::DepthEncoding::LinearDistance)
    /// `range / 65536`.
    pub format: wgpu::TextureFormat,
    /// Bias for receivers, in texels. Default [`Bias::default`]. Its `slope_scale` is the rasteriser's.
    pub bias: Bias,
    /// Which sides of casters are drawn. Default [`CasterSides::Nearest`].
    pub sides: CasterSides,
    /// How far kernels reach from a receiver: [`Kernel::radius`](crate::Kernel::radius) of the widest that
    /// reads the map; [`PcfSampler::bind_group`](crate::PcfSampler::bind_group) refuses wider ones. What only
    /// such kernels read is kept up to date, too, and what is fitted to a view or to receivers is made that
    /// much wider. Default 12 texels, as wide as any kernel is by default. Greater than 0, at most 64 texels;
    /// a reach in world units holds kernels of up to 12 texels, too.
    ///
    /// Of texels, with one more for rounding, no more than a quarter of a directional light's map or cascade
    /// ([`ShadowMapError::ReachOfSize`](crate::error::ShadowMapError),
    /// [`CascadeError::ReachOfSize`](crate::error::CascadeError)).
    pub reach: Radius,
}

impl Default for MapSettings {
    fn default() -> Self {
        Self {
            format: wgpu::TextureFormat::Depth32Float,
            bias: Bias::default(),
            sides: CasterSides::default(),
            reach: Radius::Texels(Radius::USUAL_TEXELS),
        }
    }
}

impl MapSettings {
    pub(super) fn validate(&self) -> Result<(), MapSettingsError> {
        if quantum(self.format).is_none() {
            return Err(MapSettingsError::Format(self.format));
        }
        if !self.reach.is_in_range() {
            return Err(MapSettingsError::Reach(self.reach));
        }
        Ok(self.bias.validate()?)
    }
}
