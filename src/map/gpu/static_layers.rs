//! Textures of what is static on the faces of a cube map, copied under what moves.

use super::texture::CubeTextures;
use crate::map::encoding::texel_bytes;
use crate::map::projection::CubeFace;

/// The layers of a map, by slot and face.
#[derive(Debug)]
pub(crate) struct StaticLayerTextures {
    label: String,
    size: u32,
    format: wgpu::TextureFormat,
    slots: Vec<[Option<LayerTexture>; 6]>,
}

/// The layer under one face.
#[derive(Debug)]
struct LayerTexture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl StaticLayerTextures {
    pub fn new(label: &str, size: u32, format: wgpu::TextureFormat, slots: usize) -> Self {
        Self {
            label: format!("{label} static"),
            size,
            format,
            slots: (0..slots).map(|_| Default::default()).collect(),
        }
    }

    /// Makes one, if it is not there.
    pub fn make(&mut self, device: &wgpu::Device, slot: usize, face: usize) {
        let layer = &mut self.slots[slot][face];
        if layer.is_none() {
            *layer = Some(LayerTexture::new(
                device,
                &self.label,
                self.size,
                self.format,
            ));
        }
    }

    /// Gives a slot's layers back.
    pub fn free(&mut self, slot: usize) {
        self.slots[slot] = Default::default();
    }

    /// What to draw one on.
    pub fn view(&self, slot: usize, face: CubeFace) -> Option<&wgpu::TextureView> {
        Some(&self.slots[slot][face.layer() as usize].as_ref()?.view)
    }

    /// Copies one to its face.
    pub fn copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
        textures: &CubeTextures,
    ) {
        let layer = &self.slots[slot][face.layer() as usize];
        let (Some(layer), Some(target)) = (layer, textures.slot(slot)) else {
            return; // prepare made both wherever there is something to copy
        };
        let mut to = target.texture.as_image_copy();
        to.origin.z = target.first_layer + face.layer();
        encoder.copy_texture_to_texture(layer.texture.as_image_copy(), to, layer.texture.size());
    }

    pub fn bytes(&self) -> u64 {
        let layers = self.slots.iter().flatten().flatten().count() as u64;
        layers * u64::from(self.size).pow(2) * texel_bytes(self.format)
    }
}

impl LayerTexture {
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
