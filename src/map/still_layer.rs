//! The second layers of a cube map: what stands still, copied under what moves.

use super::cube::CubeShadowMap;
use super::face::CubeFace;
use super::still::Way;
use super::texture;
use crate::error::CubeShadowMapError;

/// Whether the casters of a face that stand still are kept in a second layer of depth, which is
/// copied under those that move, instead of being drawn again with them.
///
/// A caster stands still for a face once it has been the same in three draws of that face (more
/// after layers that were of no use, up to 64); so a scene in which all casters move takes no memory
/// and copies nothing. A layer is made for each face that has use for one, with as many bytes as
/// the face. Depths are the same bit for bit with and without.
///
/// Layers need copies between depth textures, which wgpu's GL back end does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StillLayers {
    /// Where enough triangles stand still for the texels of a face. Nowhere on the GL back end.
    ///
    /// On software drivers one triangle is enough for 1024 texels: 64 on a face of 256 texels a
    /// side, 1,024 on one of 1024. Mesa's llvmpipe draws a small triangle in the time in which it
    /// copies 120 to 180 texels (`texels_a_triangle` of the bench `cube_map`, five runs), and takes
    /// no longer to copy a layer than to clear a face, so a layer loses nothing but its making: one
    /// copy, which the rule has repaid within eight frames. With a caster moving on each face, a
    /// frame takes 0.4 to 1.0 of the time with 8 still triangles a face, and 0.08 to 0.2 with 4,608
    /// that cover a third of it (`static_layer_vs_redraw`).
    ///
    /// On GPUs one triangle is enough for 16 texels, which is an estimate: it supposes that
    /// clearing costs nothing, that a copied texel moves 12 bytes (read, written, and read again by
    /// the pass over it) at 500 GB/s, and that 2.5 triangles are drawn a nanosecond. Where you know
    /// better, say [`AtLeast`](Self::AtLeast).
    #[default]
    Auto,
    /// Nowhere.
    Never,
    /// Where at least so many triangles stand still on a face that is drawn (and at least one).
    AtLeast(u64),
}

impl StillLayers {
    /// The fewest triangles that are worth a layer under a face; `None` if there is to be none.
    pub(super) fn least_triangles(self, size: u32, adapter: &wgpu::AdapterInfo) -> Option<u64> {
        let texels_a_triangle = match adapter.device_type {
            wgpu::DeviceType::Cpu => 1024,
            _ => 16,
        };
        match self {
            Self::Never => None,
            Self::AtLeast(triangles) => Some(triangles.max(1)),
            Self::Auto if adapter.backend == wgpu::Backend::Gl => None,
            Self::Auto => Some(u64::from(size).pow(2).div_ceil(texels_a_triangle)),
        }
    }

    /// Refuses layers that the device cannot copy.
    pub(super) fn validate(self, adapter: &wgpu::AdapterInfo) -> Result<(), CubeShadowMapError> {
        match (self, adapter.backend) {
            (Self::AtLeast(_), wgpu::Backend::Gl) => Err(CubeShadowMapError::StillLayers),
            _ => Ok(()),
        }
    }
}

/// The layer under one face.
#[derive(Debug)]
pub(super) struct StillLayer {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl CubeShadowMap {
    /// Decides which of the faces that are drawn have a layer, and makes those.
    pub(super) fn choose_ways(&mut self, device: &wgpu::Device, index: usize, drawn: u8) {
        let Some(least) = self.still_least else {
            return;
        };
        let slot = &mut self.slots[index];
        slot.choose_ways(drawn, least, &self.scene);
        for ((face, layer), bit) in slot.faces.iter().zip(&mut self.still[index]).zip(0..) {
            let built = drawn & 1 << bit != 0 && matches!(face.still.way(), Way::Build(_));
            if built && layer.is_none() {
                let label = format!("{} still", self.label);
                *layer = Some(StillLayer::new(device, &label, self.size, self.format));
            }
        }
    }

    /// Gives a slot's layers back.
    pub(super) fn free_layers(&mut self, index: usize) {
        let faces = &mut self.slots[index].faces;
        for (face, layer) in faces.iter_mut().zip(&mut self.still[index]) {
            face.still = Default::default();
            *layer = None;
        }
    }

    pub(super) fn layer_bytes(&self) -> u64 {
        let layers = self.still.iter().flatten().flatten().count() as u64;
        layers * u64::from(self.size).pow(2) * texture::texel_bytes(self.format)
    }

    /// Copies the layer under a face, drawn first if need be. False if the face is drawn whole.
    pub(super) fn encode_layer(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
    ) -> bool {
        let place = face.layer() as usize;
        let way = self.slots[slot].faces[place].still.way();
        let (Some(layer), Some(target)) = (&self.still[slot][place], self.textures.slot(slot))
        else {
            return false; // prepare made a layer wherever there is a way that needs one
        };
        match way {
            Way::Whole => return false,
            Way::Build(_) => {
                let draws = self.draws.of_layer(slot, place);
                let mut pass =
                    self.begin_depth_pass(encoder, slot, face, &layer.view, self.clear());
                self.draw_face(&mut pass, slot, face, draws);
            }
            Way::Copy(_) => {}
        }
        let mut to = target.texture.as_image_copy();
        to.origin.z = target.first_layer + face.layer();
        encoder.copy_texture_to_texture(layer.texture.as_image_copy(), to, layer.texture.size());
        true
    }
}

impl StillLayer {
    fn new(device: &wgpu::Device, label: &str, size: u32, format: wgpu::TextureFormat) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d {
                width: size,
                height: size,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(label),
                ..Default::default()
            }),
            texture,
        }
    }
}
