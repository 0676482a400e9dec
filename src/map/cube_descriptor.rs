//! How a cube map is made, and what it is told each frame.

use super::encoding::{DepthEncoding, quantum};
use super::gpu::UNIFORM_LIGHTS;
use super::sides::CasterSides;
use super::static_layers::StaticLayers;
use crate::error::CubeShadowMapError;
use crate::mesh::Caster;
use crate::support::has_storage;
use crate::{Bias, PointLight, Radius, View};

/// When a [`CubeShadowMap`](crate::CubeShadowMap) takes its texture memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Allocation {
    /// In the first `prepare` in which a light reaches a caster; given back in the first without
    /// any light, and in the 60th in a row in which none reaches a caster (with a cube for each
    /// light: in which its own does not). Bind groups made before that must be made again
    /// ([`CubeShadowMap::texture_revision`](crate::CubeShadowMap::texture_revision)).
    #[default]
    WithFirstCaster,
    /// In `new`, for good. For hosts that draw their own geometry through
    /// [`begin_face`](crate::CubeShadowMap::begin_face), which the map cannot foresee.
    AtOnce,
}

/// How to make a [`CubeShadowMap`](crate::CubeShadowMap).
#[derive(Clone, Debug)]
pub struct CubeShadowMapDescriptor<'a> {
    /// Name of the map in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along each side of a face. Default 1024. 1 to the device's
    /// `max_texture_dimension_2d`. Memory: six faces of 4 bytes a texel (2 for `Depth16Unorm`) for
    /// each light.
    pub size: u32,
    /// Bias for receivers. Default [`Bias::default`], which needs no tuning.
    pub bias: Bias,
    /// The most lights it will hold. Default 1. At least 1; 1,536 bytes for each must fit the
    /// device's `max_buffer_size`, and six layers for each its `max_texture_array_layers` if
    /// `cube_array` is set.
    pub lights: u32,
    /// Whether all lights share one texture and one bind group: see
    /// [`PcfDescriptor::many_lights`](crate::PcfDescriptor::many_lights). Default false: one texture
    /// for each light, and one bind group for each
    /// ([`PcfSampler::bind_group_of`](crate::PcfSampler::bind_group_of)). Receivers see the same.
    pub cube_array: bool,
    /// When the texture is made. Default [`Allocation::WithFirstCaster`].
    pub allocation: Allocation,
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
    /// Whether casters go only on the faces they touch. Default true; false draws every caster on
    /// every face, for measuring what culling is worth.
    pub cull_casters: bool,
    /// Whether faces whose content has not changed are left alone. Default true; false draws every
    /// face every frame, for measuring what that is worth.
    pub cache: bool,
    /// Which sides of casters are drawn. Default [`CasterSides::Nearest`].
    pub sides: CasterSides,
    /// The most faces drawn in one `prepare`; default none. At least 1. A light that moved has its
    /// faces drawn together, which may be up to five more. See
    /// [`CubeShadowMap::max_age`](crate::CubeShadowMap::max_age) for the order, the longest wait and
    /// what the budget does not count.
    pub max_faces_per_frame: Option<u32>,
    /// Whether static casters are kept in a second layer under those that move. Default
    /// [`StaticLayers::Auto`]. Without `cache` there are none, and [`StaticLayers::AtLeast`] is
    /// refused.
    pub static_layers: StaticLayers,
}

impl CubeShadowMapDescriptor<'_> {
    /// The method as textbooks have it: six passes with every caster in each, every frame,
    /// `distance / range` written by the fragment shader. To be read with
    /// [`PcfDescriptor::textbook`](crate::PcfDescriptor). For comparison, not for use.
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

    /// `most_tiles`: as many as have room for their matrices.
    pub(super) fn validate(
        &self,
        device: &wgpu::Device,
        most_tiles: u32,
    ) -> Result<(), CubeShadowMapError> {
        let limits = device.limits();
        let limit = limits.max_texture_dimension_2d;
        if self.size == 0 || self.size > limit {
            return Err(CubeShadowMapError::Size {
                size: self.size,
                limit,
            });
        }
        let most = self.most_lights(device, most_tiles);
        if self.lights == 0 || self.lights > most {
            return Err(CubeShadowMapError::Slots {
                lights: self.lights,
                limit: most,
            });
        }
        if quantum(self.format).is_none() {
            return Err(CubeShadowMapError::Format(self.format));
        }
        if !self.reach.is_in_range() {
            return Err(CubeShadowMapError::Reach(self.reach));
        }
        if self.max_faces_per_frame == Some(0) {
            return Err(CubeShadowMapError::Budget);
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

    /// As many as have room for their matrices, and in one texture for their layers.
    fn most_lights(&self, device: &wgpu::Device, most_tiles: u32) -> u32 {
        if !self.cube_array {
            return most_tiles / 6;
        }
        let bound = match has_storage(device) {
            true => u32::MAX,
            false => UNIFORM_LIGHTS,
        };
        // The GL back end wants a spare layer.
        let layers = device.limits().max_texture_array_layers.saturating_sub(1);
        (most_tiles / 6).min(layers / 6).min(bound)
    }

    /// The fewest triangles of static casters on a face that are worth a layer.
    pub(super) fn layer_least(&self, device: &wgpu::Device) -> Option<u64> {
        self.static_layers
            .least_triangles(self.size, &device.adapter_info())
            .filter(|_| self.cache)
    }
}

impl Default for CubeShadowMapDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: 1024,
            bias: Bias::default(),
            lights: 1,
            cube_array: false,
            allocation: Allocation::default(),
            encoding: DepthEncoding::default(),
            format: wgpu::TextureFormat::Depth32Float,
            reach: Radius::Texels(Radius::USUAL_TEXELS),
            cull_casters: true,
            cache: true,
            sides: CasterSides::default(),
            max_faces_per_frame: None,
            static_layers: StaticLayers::default(),
        }
    }
}

/// What a [`CubeShadowMap`](crate::CubeShadowMap) is to show this frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct CubeFrame<'a> {
    /// The lights; shaders name them by their place here. Lights that were there last frame keep
    /// their faces wherever they now stand in the slice. Without
    /// [`cube_array`](CubeShadowMapDescriptor::cube_array) their bind groups must then be made again
    /// ([`CubeShadowMap::texture_revision`](crate::CubeShadowMap::texture_revision)).
    pub lights: &'a [PointLight],
    /// Everything that may cast; what a light cannot reach is left out by the map itself. Their
    /// order does not matter, but what is found at another place in the slice than last frame counts
    /// as moved: take casters out by `swap_remove` rather than by `remove`.
    pub casters: &'a [Caster],
    /// The host's camera: faces that no kernel reaches
    /// ([`reach`](CubeShadowMapDescriptor::reach)) from a visible receiver are put off until one
    /// does. `None` (default): all faces count. With several cameras pass `None`.
    pub view: Option<&'a View>,
    /// Places of lights whose faces are drawn whatever the budget. Default none. The others share
    /// `max_faces_per_frame`.
    pub pinned: &'a [usize],
}

impl CubeFrame<'_> {
    pub(super) fn validate(&self, slots: usize) -> Result<(), CubeShadowMapError> {
        if self.lights.len() > slots {
            return Err(CubeShadowMapError::TooManyLights {
                lights: self.lights.len(),
                slots,
            });
        }
        for light in self.lights {
            light.validate()?;
        }
        match self.pinned.iter().find(|&&at| at >= self.lights.len()) {
            Some(&pinned) => Err(CubeShadowMapError::Pinned {
                pinned,
                lights: self.lights.len(),
            }),
            None => Ok(()),
        }
    }
}
