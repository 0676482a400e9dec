//! Parameters of a cube map, and its input for each frame.

use super::encoding::{DepthEncoding, quantum};
use super::sides::CasterSides;
use super::static_layers::StaticLayers;
use crate::error::CubeShadowMapError;
use crate::mesh::Caster;
use crate::{Bias, PointLight, Radius, View};

/// Parameters of a [`CubeShadowMap`](crate::CubeShadowMap).
#[derive(Clone, Debug)]
pub struct CubeShadowMapDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along each side of a face. Default 1024. 1 to the device's
    /// `max_texture_dimension_2d`. Memory: six faces of 4 bytes a texel (2 for `Depth16Unorm`).
    pub size: u32,
    /// Bias for receivers. Default [`Bias::default`], which needs no tuning.
    pub bias: Bias,
    /// What texels hold. Default [`DepthEncoding::MajorAxis`].
    pub encoding: DepthEncoding,
    /// `Depth32Float` (default), `Depth24Plus` or `Depth16Unorm`. The last two round depths to one
    /// part in 2^24 and 2^16 of their range, and receivers are given one such step as bias: with
    /// `LinearDistance` that is `range / 65536` in world units, with `MajorAxis`
    /// `d * d / (near * 65536)` at distance `d`.
    pub format: wgpu::TextureFormat,
    /// How far kernels reach from a receiver: [`Kernel::radius`](crate::Kernel::radius) of the
    /// widest that reads the map; [`PcfSampler::bind_group`](crate::PcfSampler::bind_group) refuses
    /// wider ones. Faces that only such kernels reach from what a frame's [`view`](CubeFrame::view)
    /// shows are kept up to date, too. Default 12 texels, as wide as any kernel is by default. Greater
    /// than 0, at most 64 texels. A reach in world units holds kernels of up to 12 texels, too.
    pub reach: Radius,
    /// Whether casters are drawn only on the faces they touch. Default true; false draws every caster on
    /// every face, to measure the benefit of culling.
    #[doc(hidden)]
    pub cull_casters: bool,
    /// Whether faces whose content has not changed are left alone. Default true; false redraws every face
    /// every frame, to measure the benefit.
    #[doc(hidden)]
    pub cache: bool,
    /// Which sides of casters are drawn. Default [`CasterSides::Nearest`].
    pub sides: CasterSides,
    /// Whether static casters are cached in a second layer under those that move. Default
    /// [`StaticLayers::Auto`]. Without `cache` there are no such layers, and [`StaticLayers::AtLeast`] is
    /// rejected.
    pub static_layers: StaticLayers,
}

impl CubeShadowMapDescriptor<'_> {
    /// The textbook method: six passes in every frame with all casters in each, and `distance / range`
    /// written by the fragment shader. To be read with [`PcfDescriptor::textbook`](crate::PcfDescriptor). For
    /// comparison only.
    pub fn textbook() -> Self {
        Self {
            bias: Bias::NONE,
            encoding: DepthEncoding::LinearDistance,
            cull_casters: false,
            cache: false,
            sides: CasterSides::Both,
            ..Self::default()
        }
    }

    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), CubeShadowMapError> {
        let limit = device.limits().max_texture_dimension_2d;
        if self.size == 0 || self.size > limit {
            return Err(CubeShadowMapError::Size {
                size: self.size,
                limit,
            });
        }
        if quantum(self.format).is_none() {
            return Err(CubeShadowMapError::Format(self.format));
        }
        if !self.reach.is_in_range() {
            return Err(CubeShadowMapError::Reach(self.reach));
        }
        self.static_layers.validate(&device.adapter_info())?;
        if matches!(self.static_layers, StaticLayers::AtLeast(_)) && !self.cache {
            return Err(CubeShadowMapError::NoStaticLayers);
        }
        self.bias.validate()?;
        if self.bias.slope_scale != 0.0 && self.encoding == DepthEncoding::LinearDistance {
            return Err(CubeShadowMapError::SlopeScale);
        }
        Ok(())
    }

    /// The fewest triangles of static casters on a face that are worth a layer.
    pub(super) fn layer_least(&self, device: &wgpu::Device) -> Option<u64> {
        self.static_layers
            .least_triangles(self.size, &device.adapter_info())
    }
}

impl Default for CubeShadowMapDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: 1024,
            bias: Bias::default(),
            encoding: DepthEncoding::default(),
            format: wgpu::TextureFormat::Depth32Float,
            reach: Radius::Texels(Radius::USUAL_TEXELS),
            cull_casters: true,
            cache: true,
            sides: CasterSides::default(),
            static_layers: StaticLayers::default(),
        }
    }
}

/// The input of a [`CubeShadowMap`](crate::CubeShadowMap) for one frame.
#[derive(Clone, Copy, Debug)]
pub struct CubeFrame<'a> {
    /// The light.
    pub light: PointLight,
    /// Everything that may cast; the map itself leaves out what the light cannot reach. The order does not
    /// matter, but a caster at another index than in the last frame counts as moved: remove casters with
    /// `swap_remove` rather than `remove`.
    pub casters: &'a [Caster],
    /// The host's camera: faces that no kernel reaches
    /// ([`reach`](CubeShadowMapDescriptor::reach)) from a visible receiver are put off until one
    /// does. `None`: all faces count. With several cameras pass `None`.
    pub view: Option<&'a View>,
}

impl<'a> CubeFrame<'a> {
    /// A frame without a view.
    pub fn new(light: PointLight, casters: &'a [Caster]) -> Self {
        Self {
            light,
            casters,
            view: None,
        }
    }
}
