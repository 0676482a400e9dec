//! Depth settings shared by maps of all kinds.

use super::bias::Bias;
use super::encoding::quantum;
use super::sides::CasterSides;
use crate::Radius;
use crate::error::MapSettingsError;

/// How depths of a [`CubeShadowMap`](crate::CubeShadowMap), a [`ShadowMap`](crate::ShadowMap) or a
/// [`ShadowAtlas`](crate::ShadowAtlas) are stored, drawn and compared. The default needs no tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSettings {
    /// `Depth32Float` (default), `Depth24Plus` or `Depth16Unorm`. The last two round depths to one part in 2^24
    /// and 2^16 of their range, and receivers are given one such step as bias: `d * d / (near * 65536)` at
    /// distance `d` in world units for a point light or a spot, 1 / 65536 of the depth that its map or cascade
    /// covers for a directional light, and `range / 65536` with
    /// [`LinearDistance`](crate::DepthEncoding::LinearDistance).
    pub format: wgpu::TextureFormat,
    /// Bias for receivers, in texels. Default [`Bias::default`]. Its `slope_scale` is the rasteriser's.
    pub bias: Bias,
    /// Which sides of casters are drawn. Default [`CasterSides::Nearest`].
    pub sides: CasterSides,
    /// How far kernels reach from a receiver: [`Kernel::radius`](crate::Kernel::radius) of the widest that
    /// reads the map; [`PcfSampler::bind_group`](crate::PcfSampler::bind_group) rejects wider ones. Texels
    /// that only such kernels read are kept up to date, too, and maps fitted to a view or to receivers are
    /// widened by this much. Default 12 texels, the width of the widest kernel by default. Greater than 0, at
    /// most 64 texels; a reach in world units also covers kernels of up to 12 texels.
    ///
    /// In texels, with one more for rounding, it may be at most a quarter of a directional light's map or
    /// cascade ([`ShadowMapError::ReachOfSize`](crate::error::ShadowMapError),
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
