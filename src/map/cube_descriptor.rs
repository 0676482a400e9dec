//! Parameters of a cube map, and its input for each frame.

use super::encoding::DepthEncoding;
use super::settings::MapSettings;
use super::sides::CasterSides;
use super::static_layers::StaticLayers;
use crate::error::CubeShadowMapError;
use crate::mesh::Caster;
use crate::{Bias, PointLight, View};

/// Parameters of a [`CubeShadowMap`](crate::CubeShadowMap).
#[derive(Clone, Debug)]
pub struct CubeShadowMapDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along each side of a face. Default 1024. 1 to the device's
    /// `max_texture_dimension_2d`. Memory: six faces of 4 bytes a texel (2 for `Depth16Unorm`).
    pub size: u32,
    /// What texels hold. Default [`DepthEncoding::MajorAxis`].
    pub encoding: DepthEncoding,
    /// How depths are stored, drawn and compared. With `LinearDistance` there is no
    /// [`slope_scale`](crate::Bias::slope_scale).
    pub settings: MapSettings,
    /// Whether casters are drawn only on the faces they touch. Default true; false draws every caster on
    /// every face, to measure the benefit of culling.
    #[doc(hidden)]
    pub cull_casters: bool,
    /// Whether faces whose content has not changed are left alone. Default true; false redraws every face
    /// every frame, to measure the benefit.
    #[doc(hidden)]
    pub cache: bool,
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
            encoding: DepthEncoding::LinearDistance,
            settings: MapSettings {
                bias: Bias::NONE,
                sides: CasterSides::Both,
                ..MapSettings::default()
            },
            cull_casters: false,
            cache: false,
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
        self.settings.validate()?;
        self.static_layers.validate(&device.adapter_info())?;
        if matches!(self.static_layers, StaticLayers::AtLeast(_)) && !self.cache {
            return Err(CubeShadowMapError::NoStaticLayers);
        }
        if self.settings.bias.slope_scale != 0.0 && self.encoding == DepthEncoding::LinearDistance {
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
            encoding: DepthEncoding::default(),
            settings: MapSettings::default(),
            cull_casters: true,
            cache: true,
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
    /// ([`reach`](MapSettings::reach)) from a visible receiver are put off until one
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
