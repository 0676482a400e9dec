//! Textures of what is static on the tiles of a map, copied under what moves.

use super::texture::layer_view;
use crate::map::encoding::texel_bytes;

/// The static layers of a map, by tile.
#[derive(Debug)]
pub(crate) struct StaticLayerTextures {
    label: String,
    size: u32,
    format: wgpu::TextureFormat,
    tiles: Vec<Option<LayerTexture>>,
}

/// The layer under one tile.
#[derive(Debug)]
struct LayerTexture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl StaticLayerTextures {
    pub fn new(label: &str, size: u32, format: wgpu::TextureFormat, tiles: usize) -> Self {
        Self {
            label: format!("{label} static"),
            size,
            format,
            tiles: (0..tiles).map(|_| None).collect(),
        }
    }

    /// Makes one, if it is not there.
    pub fn make(&mut self, device: &wgpu::Device, tile: usize) {
        let layer = &mut self.tiles[tile];
        if layer.is_none() {
            *layer = Some(LayerTexture::new(
                device,
                &self.label,
                self.size,
                self.format,
            ));
        }
    }

    /// What to draw one on.
    pub fn view(&self, tile: usize) -> Option<&wgpu::TextureView> {
        Some(&self.tiles[tile].as_ref()?.view)
    }

    /// Copies one to the layer of its tile.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, tile: usize, target: &wgpu::Texture) {
        let Some(layer) = &self.tiles[tile] else {
            return; // prepare made one wherever there is something to copy
        };
        let mut to = target.as_image_copy();
        to.origin.z = tile as u32;
        encoder.copy_texture_to_texture(layer.texture.as_image_copy(), to, layer.texture.size());
    }

    pub fn bytes(&self) -> u64 {
        let layers = self.tiles.iter().flatten().count() as u64;
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
            view: layer_view(&texture, label, 0),
            texture,
        }
    }
}
