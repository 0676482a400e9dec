//! The layers that an atlas's tiles lie in.

use super::texture::{array_view, create_texture, layer_view};
use crate::gl;
use crate::map::encoding::texel_bytes;

/// Frames for which at least half of the layers were empty after which those are given back.
const IDLE: u32 = 60;

/// One texture for all tiles.
#[derive(Debug)]
pub(crate) struct AtlasTexture {
    label: String,
    /// Texels along a side.
    size: u32,
    format: wgpu::TextureFormat,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    layers: Vec<Layer>,
    /// What the next encode copies over from.
    before: Option<wgpu::Texture>,
    /// Whether texels can be copied from one texture to the next.
    copies: bool,
    spare: u32,
    revision: u64,
}

/// One layer, and what is static on it.
#[derive(Debug)]
struct Layer {
    view: wgpu::TextureView,
    /// Of the same size.
    statics: Option<StaticTexture>,
}

#[derive(Debug)]
pub(crate) struct StaticTexture {
    pub view: wgpu::TextureView,
    /// What [`TileFill`](super::TileFill) copies from.
    pub source: wgpu::BindGroup,
}

/// What a new size did to the texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Resized {
    No,
    /// They are copied.
    Kept,
    /// They are gone.
    Lost,
}

impl AtlasTexture {
    /// Nothing but a placeholder, until tiles need layers.
    pub fn new(device: &wgpu::Device, label: &str, size: u32, format: wgpu::TextureFormat) -> Self {
        let (texture, view) = make(device, label, 1, format, 0);
        Self {
            label: label.to_owned(),
            size,
            format,
            texture,
            view,
            layers: Vec::new(),
            before: None,
            copies: !gl::is_gl(device) && format != wgpu::TextureFormat::Depth24Plus,
            spare: 0,
            revision: 0,
        }
    }

    /// Makes as many layers as are needed, and gives back what has long been too many.
    pub fn resize(&mut self, device: &wgpu::Device, needed: u32) -> Resized {
        let have = self.layers.len() as u32;
        self.spare = match needed * 2 <= have && have > 0 {
            true => self.spare + 1,
            false => 0,
        };
        let wanted = match self.spare > IDLE {
            true => needed,
            false => needed.max(have),
        };
        if wanted == have {
            return Resized::No;
        }
        self.spare = 0;
        self.revision += 1;
        let size = if wanted == 0 { 1 } else { self.size };
        let (texture, view) = make(device, &self.label, size, self.format, wanted);
        let before = std::mem::replace(&mut self.texture, texture);
        self.view = view;
        let mut statics = std::mem::take(&mut self.layers)
            .into_iter()
            .map(|layer| layer.statics);
        self.layers = (0..wanted)
            .map(|layer| Layer {
                view: layer_view(&self.texture, &self.label, layer),
                statics: statics.next().flatten(),
            })
            .collect();
        match have.min(wanted) {
            0 => {
                self.before = None;
                Resized::No
            }
            _ if self.copies => {
                // Where that was not copied yet, this one was never drawn on.
                self.before.get_or_insert(before);
                Resized::Kept
            }
            _ => Resized::Lost,
        }
    }

    /// Copies what was drawn before the texture changed its size; whether there was any.
    pub fn carry_over(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        let Some(before) = self.before.take() else {
            return false;
        };
        let layers = before.depth_or_array_layers().min(self.layers.len() as u32);
        let size = wgpu::Extent3d {
            depth_or_array_layers: layers,
            ..before.size()
        };
        encoder.copy_texture_to_texture(before.as_image_copy(), self.texture.as_image_copy(), size);
        true
    }

    /// Nothing is copied over: the texels are not known.
    pub fn doubt(&mut self) {
        self.before = None;
    }

    /// Makes the texture of what is static on a layer, if it is not there.
    pub fn make_statics(
        &mut self,
        device: &wgpu::Device,
        layer: u32,
        source: impl FnOnce(&wgpu::TextureView) -> wgpu::BindGroup,
    ) {
        let Some(layer) = self.layers.get_mut(layer as usize) else {
            return;
        };
        if layer.statics.is_none() {
            let label = format!("{} static", self.label);
            let texture = create_texture(device, &label, self.size, self.format, 1);
            let view = layer_view(&texture, &label, 0);
            let source = source(&view);
            layer.statics = Some(StaticTexture { view, source });
        }
    }

    /// One layer, to be drawn on.
    pub fn layer(&self, layer: u32) -> Option<&wgpu::TextureView> {
        Some(&self.layers.get(layer as usize)?.view)
    }

    pub fn statics(&self, layer: u32) -> Option<&StaticTexture> {
        self.layers.get(layer as usize)?.statics.as_ref()
    }

    /// All layers, to be read.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// Texels of one layer.
    pub fn layer_texels(&self) -> u64 {
        u64::from(self.size).pow(2)
    }

    pub fn layers(&self) -> u32 {
        self.layers.len() as u32
    }

    /// Changes with the view.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    pub fn bytes(&self) -> u64 {
        let texels = u64::from(self.size).pow(2) * texel_bytes(self.format);
        let statics = self.layers.iter().filter(|layer| layer.statics.is_some());
        let layers = match self.layers.len() {
            0 => 0,
            _ => u64::from(self.texture.depth_or_array_layers()),
        };
        texels * (layers + statics.count() as u64)
    }
}

fn make(
    device: &wgpu::Device,
    label: &str,
    size: u32,
    format: wgpu::TextureFormat,
    layers: u32,
) -> (wgpu::Texture, wgpu::TextureView) {
    let layers = gl::array_layers(device, layers.max(1));
    let texture = create_texture(device, label, size, format, layers);
    let view = array_view(&texture, label);
    (texture, view)
}
