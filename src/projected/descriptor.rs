//! What projected shadows are made from and told each frame.

use super::draws::INSTANCE_SIZE;
use super::record::most_records;
use super::texture::{LEAST_TILE, layer_bytes};
use crate::error::ProjectedShadowError;
use crate::mesh::Caster;
use crate::{Light, gl};

/// How to make a [`ProjectedShadow`](crate::ProjectedShadow).
#[derive(Clone, Debug)]
pub struct ProjectedShadowDescriptor<'a> {
    /// Name of the shadows in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along a side of a layer of the texture, the largest size of a tile: a power of two from 8 to
    /// 8192, up to the device's `max_texture_dimension_2d`. Default 1024. Layers are made when shadows need
    /// them.
    pub layer_size: u32,
    /// Bytes that layers may take, with their mip levels (4 bytes a texel, and a third); as many whole layers
    /// as that gives, at least one. Default 64 MiB: twelve layers of 1024 texels, 192 shadows of 256.
    pub memory: u64,
    /// Whether shadows whose light and casters have not changed are left alone. Default true; false draws
    /// all of them every frame, for measuring what that is worth.
    #[doc(hidden)]
    pub cache: bool,
}

impl Default for ProjectedShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            layer_size: 1024,
            memory: 64 << 20,
            cache: true,
        }
    }
}

impl ProjectedShadowDescriptor<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), ProjectedShadowError> {
        let limit = device.limits().max_texture_dimension_2d.min(8192);
        let size = self.layer_size;
        if !size.is_power_of_two() || !(LEAST_TILE..=limit).contains(&size) {
            return Err(ProjectedShadowError::LayerSize {
                size,
                least: LEAST_TILE,
                limit,
            });
        }
        let (memory, layer) = (self.memory, layer_bytes(size));
        match memory < layer {
            true => Err(ProjectedShadowError::Memory { memory, layer }),
            false => Ok(()),
        }
    }

    /// As many layers as memory and the device have room for.
    pub(super) fn most_layers(&self, device: &wgpu::Device) -> u32 {
        let limit = device.limits().max_texture_array_layers;
        // wgpu's GL back end may want one more: `gl::array_layers`.
        let limit = limit - u32::from(gl::is_gl(device));
        (self.memory / layer_bytes(self.layer_size)).min(u64::from(limit)) as u32
    }
}

/// A caster, and what of the light comes through it.
#[derive(Clone, Debug)]
pub struct ProjectedCaster {
    /// The caster.
    pub caster: Caster,
    /// What of red, green and blue light comes through one of its surfaces: 0 (opaque) to 1 (clear), linear.
    ///
    /// Of a mesh that is closed and wound counter-clockwise seen from outside, as found when it is made, that is
    /// once for each time the light leaves it; of any other mesh (open, or in a buffer of the host's) for
    /// each triangle that the light passes.
    pub transmittance: [f32; 3],
}

impl ProjectedCaster {
    /// A caster that lets no light through.
    pub fn opaque(caster: Caster) -> Self {
        Self::new(caster, [0.0; 3])
    }

    /// A caster that lets through so much of red, green and blue light.
    pub fn new(caster: Caster, transmittance: [f32; 3]) -> Self {
        Self {
            caster,
            transmittance,
        }
    }
}

/// One light, the casters whose shadow from it is one tile, and that tile's size.
///
/// The tile is a square around the casters as the light sees them. Casters that are far apart as the light
/// sees them are better given to several projectors: each then has a tile of its own, and a near distance of
/// its own.
#[derive(Clone, Copy, Debug)]
pub struct Projector<'a> {
    /// The light. A point light or a spot takes a square around the casters, up to 84 degrees to each side; a
    /// spot whose cone is narrower than that takes the square around its cone. Casters beyond a light's
    /// range cast nothing.
    pub light: Light,
    /// What casts; in any order.
    pub casters: &'a [ProjectedCaster],
    /// Texels along a side of the tile: a power of two from 8 to
    /// [`layer_size`](ProjectedShadowDescriptor::layer_size).
    pub size: u32,
}

impl<'a> Projector<'a> {
    /// A projector with a tile of 256 texels a side.
    pub fn new(light: impl Into<Light>, casters: &'a [ProjectedCaster]) -> Self {
        Self {
            light: light.into(),
            casters,
            size: 256,
        }
    }

    /// The same with a tile of another size.
    #[must_use]
    pub fn with_size(self, size: u32) -> Self {
        Self { size, ..self }
    }

    fn validate(
        &self,
        projector: usize,
        device: &wgpu::Device,
        most: u32,
    ) -> Result<(), ProjectedShadowError> {
        let size = self.size;
        if !size.is_power_of_two() || !(LEAST_TILE..=most).contains(&size) {
            return Err(ProjectedShadowError::Size {
                projector,
                size,
                least: LEAST_TILE,
                most,
            });
        }
        let of_light = |source| ProjectedShadowError::Light { projector, source };
        self.light.validate().map_err(of_light)?;
        for (index, caster) in self.casters.iter().enumerate() {
            let of_caster = |source| ProjectedShadowError::Caster { projector, source };
            caster.caster.validate(index, device).map_err(of_caster)?;
            if caster.caster.mesh.is_host_drawn() {
                return Err(ProjectedShadowError::HostDrawn {
                    projector,
                    caster: index,
                });
            }
            let transmittance = caster.transmittance;
            if !transmittance.iter().all(|part| (0.0..=1.0).contains(part)) {
                return Err(ProjectedShadowError::Transmittance {
                    projector,
                    caster: index,
                    transmittance,
                });
            }
        }
        Ok(())
    }
}

/// What a [`ProjectedShadow`](crate::ProjectedShadow) is to show this frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProjectedFrame<'a> {
    /// The shadows; shaders name each by its place here.
    pub projectors: &'a [Projector<'a>],
}

impl ProjectedFrame<'_> {
    pub(super) fn validate(
        &self,
        device: &wgpu::Device,
        layer_size: u32,
    ) -> Result<(), ProjectedShadowError> {
        let (projectors, limit) = (self.projectors.len(), most_records(device));
        if projectors > limit {
            return Err(ProjectedShadowError::TooManyProjectors { projectors, limit });
        }
        for (index, projector) in self.projectors.iter().enumerate() {
            projector.validate(index, device, layer_size)?;
        }
        let casters = self.projectors.iter();
        let casters: usize = casters.map(|projector| projector.casters.len()).sum();
        let (size, limit) = (
            casters as u64 * INSTANCE_SIZE,
            device.limits().max_buffer_size,
        );
        match size > limit {
            true => Err(ProjectedShadowError::TooManyCasters {
                casters,
                size,
                limit,
            }),
            false => Ok(()),
        }
    }
}
