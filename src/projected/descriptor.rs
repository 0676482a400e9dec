//! Parameters of projected shadows, and their input for each frame.

use super::draws::INSTANCE_SIZE;
use super::record::most_records;
use super::texture::{LEAST_TILE, layer_bytes};
use crate::error::ProjectedShadowError;
use crate::mesh::Caster;
use crate::{Light, gl};

/// Parameters of a [`ProjectedShadow`](crate::ProjectedShadow).
#[derive(Clone, Debug)]
pub struct ProjectedShadowDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along a side of a layer of the texture, which is also the largest size of a tile: a power of
    /// two from 8 to 8192, up to the device's `max_texture_dimension_2d`. Default 1024. Layers are created
    /// when shadows need them.
    pub layer_size: u32,
    /// Bytes that layers may take, including their mip levels (4 bytes per texel, plus a third). Rounded down
    /// to whole layers, but at least one. Default 64 MiB: twelve layers of 1024 texels, or 192 shadows of
    /// 256.
    pub memory: u64,
    /// Whether shadows whose light and casters have not changed are left alone. Default true; false redraws
    /// all of them every frame, to measure the benefit.
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

/// A caster, and how much light it lets through.
#[derive(Clone, Debug)]
pub struct ProjectedCaster {
    /// The caster.
    pub caster: Caster,
    /// The share of red, green and blue light that one of its surfaces lets through: 0 (opaque) to 1 (clear),
    /// linear.
    ///
    /// For a closed mesh wound counter-clockwise seen from outside (determined when it is created), this applies
    /// once each time the light leaves it; for any other mesh (open, or in a buffer of the host's), to each
    /// triangle that the light passes through.
    pub transmittance: [f32; 3],
}

impl ProjectedCaster {
    /// A caster that lets no light through.
    pub fn opaque(caster: Caster) -> Self {
        Self::new(caster, [0.0; 3])
    }

    /// A caster that lets through this share of red, green and blue light.
    pub fn new(caster: Caster, transmittance: [f32; 3]) -> Self {
        Self {
            caster,
            transmittance,
        }
    }
}

/// One light, the casters whose shadow from it shares one tile, and that tile's size.
///
/// The tile is a square around the casters as seen from the light. Casters that are far apart from that
/// viewpoint are better split among several projectors, each of which then has its own tile and near
/// distance.
#[derive(Clone, Copy, Debug)]
pub struct Projector<'a> {
    /// The light. For a point light or a spot, the tile is a square around the casters, up to 84 degrees to
    /// each side; for a spot whose cone is narrower than that, it is the square around its cone. Casters
    /// beyond a light's range cast nothing.
    pub light: Light,
    /// The casters, in any order.
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

    /// The same projector with a tile of another size.
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

/// The input of a [`ProjectedShadow`](crate::ProjectedShadow) for one frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProjectedFrame<'a> {
    /// The shadows; shaders identify each by its index here.
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
