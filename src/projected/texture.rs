//! The texture that all tiles lie in, with its mip levels.

use crate::gl;

/// What of red, green and blue light comes through, in steps of 1 / 255, linear.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Texels along the smallest tile.
pub(super) const LEAST_TILE: u32 = 8;

const TEXEL_BYTES: u64 = 4;

/// Bytes of a layer with all its levels: each has a quarter of the texels of the one before.
pub(super) fn layer_bytes(size: u32) -> u64 {
    (0..level_count(size))
        .map(|level| TEXEL_BYTES * u64::from(size >> level).pow(2))
        .sum()
}

/// Levels down to one texel.
fn level_count(size: u32) -> u32 {
    size.ilog2() + 1
}

/// Layers with views of their levels.
#[derive(Debug)]
pub(super) struct MipTexture {
    texture: wgpu::Texture,
    /// All layers and levels, to be read.
    view: wgpu::TextureView,
    /// One level of all layers, to make the next one of.
    levels: Vec<wgpu::TextureView>,
    /// To draw on: by layer, then by level.
    targets: Vec<Vec<wgpu::TextureView>>,
}

impl MipTexture {
    pub fn new(device: &wgpu::Device, label: &str, size: u32, layers: u32) -> Self {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d {
                width: size,
                height: size,
                depth_or_array_layers: gl::array_layers(device, layers),
            },
            mip_level_count: level_count(size),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let level_of = |level, dimension, layer: Option<u32>| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(&format!("{label} level {level}")),
                dimension: Some(dimension),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer.unwrap_or(0),
                array_layer_count: layer.map(|_| 1),
                ..Default::default()
            })
        };
        let array = wgpu::TextureViewDimension::D2Array;
        let levels = 0..level_count(size);
        Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(label),
                dimension: Some(array),
                ..Default::default()
            }),
            levels: levels
                .clone()
                .map(|level| level_of(level, array, None))
                .collect(),
            targets: (0..layers)
                .map(|layer| {
                    let target =
                        |level| level_of(level, wgpu::TextureViewDimension::D2, Some(layer));
                    levels.clone().map(target).collect()
                })
                .collect(),
            texture,
        }
    }

    /// What is bound as long as no shadow has a tile.
    pub fn placeholder(device: &wgpu::Device, label: &str) -> Self {
        Self {
            targets: Vec::new(),
            ..Self::new(device, label, 1, 1)
        }
    }

    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    pub fn levels(&self) -> &[wgpu::TextureView] {
        &self.levels
    }

    pub fn target(&self, layer: u32, level: u32) -> Option<&wgpu::TextureView> {
        self.targets.get(layer as usize)?.get(level as usize)
    }

    /// Layers that tiles may lie in.
    pub fn layers(&self) -> u32 {
        self.targets.len() as u32
    }

    pub fn bytes(&self) -> u64 {
        u64::from(self.texture.depth_or_array_layers()) * layer_bytes(self.texture.width())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_has_a_third_more_texels_than_its_finest_level() {
        assert_eq!(layer_bytes(8), 4 * (64 + 16 + 4 + 1));
        assert_eq!((64 << 20) / layer_bytes(1024), 12);
        assert_eq!(level_count(1024), 11);
    }
}
