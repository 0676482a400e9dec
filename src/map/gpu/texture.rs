//! The textures of a cube map, made when the first light casts.

use crate::gl;
use crate::map::encoding::texel_bytes;
use crate::map::projection::CubeFace;

/// One light's six layers.
#[derive(Debug)]
pub(crate) struct SlotTexture {
    pub texture: wgpu::Texture,
    pub first_layer: u32,
    /// `None` where the device takes no layers for a cube.
    cube: Option<wgpu::TextureView>,
    /// All layers of the texture.
    all: wgpu::TextureView,
    pub faces: [wgpu::TextureView; 6],
}

/// A texture for all lights, or one for each, or none yet.
#[derive(Debug)]
pub(crate) struct CubeTextures {
    label: String,
    size: u32,
    format: wgpu::TextureFormat,
    slots: Vec<Option<SlotTexture>>,
    /// Whether one texture is for all.
    shared: bool,
    /// A texel for each face, bound as long as there is nothing else.
    placeholder: SlotTexture,
    placeholder_is_clear: bool,
    revision: u64,
}

impl CubeTextures {
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        size: u32,
        format: wgpu::TextureFormat,
        slots: usize,
        shared: bool,
    ) -> Self {
        let placeholder = create_texture(device, label, 1, format, gl::array_layers(device, 6));
        Self {
            label: label.to_owned(),
            size,
            format,
            slots: (0..slots).map(|_| None).collect(),
            shared,
            placeholder: SlotTexture::new(device, placeholder, label, 0),
            placeholder_is_clear: false,
            revision: 0,
        }
    }

    /// Makes what a slot needs. Gives the slots whose texels are new.
    pub fn allocate(&mut self, device: &wgpu::Device, slot: usize) -> std::ops::Range<usize> {
        if self.slots[slot].is_some() {
            return 0..0;
        }
        self.revision += 1;
        let slots = match self.shared {
            true => 0..self.slots.len(),
            false => slot..slot + 1,
        };
        let layers = gl::array_layers(device, 6 * slots.len() as u32);
        let texture = create_texture(device, &self.label, self.size, self.format, layers);
        for (slot, first_layer) in self.slots[slots.clone()].iter_mut().zip((0..).step_by(6)) {
            let texture = texture.clone();
            *slot = Some(SlotTexture::new(device, texture, &self.label, first_layer));
        }
        slots
    }

    /// Gives a slot's texels back; false if it had none. A texture for all goes with the last of its
    /// slots, so all must be freed.
    pub fn free(&mut self, slot: usize) -> bool {
        let had = self.slots[slot].take().is_some();
        self.revision += u64::from(had);
        had
    }

    /// How many lights it is for.
    pub fn slots(&self) -> usize {
        self.slots.len()
    }

    pub fn slot(&self, slot: usize) -> Option<&SlotTexture> {
        self.slots.get(slot)?.as_ref()
    }

    /// A light's cube, or a placeholder; `None` if the device takes no layers for a cube.
    pub fn cube(&self, slot: usize) -> Option<&wgpu::TextureView> {
        self.bound(slot).cube.as_ref()
    }

    /// All layers of the texture that a light is in, or of a placeholder.
    pub fn layers(&self, slot: usize) -> &wgpu::TextureView {
        &self.bound(slot).all
    }

    fn bound(&self, slot: usize) -> &SlotTexture {
        self.slot(slot).unwrap_or(&self.placeholder)
    }

    /// The faces of the placeholder, until they are said to be clear.
    pub fn to_be_cleared(&self) -> &[wgpu::TextureView] {
        match self.placeholder_is_clear {
            true => &[],
            false => &self.placeholder.faces,
        }
    }

    /// Learns that the placeholder is clear.
    pub fn placeholder_cleared(&mut self) {
        self.placeholder_is_clear = true;
    }

    /// Nothing is known of the placeholder's texels any more.
    pub fn doubt(&mut self) {
        self.placeholder_is_clear = false;
    }

    pub fn revision(&self) -> u64 {
        self.revision
    }

    pub fn bytes(&self) -> u64 {
        let textures = self.slots.iter().flatten();
        let textures = textures.filter(|slot| slot.first_layer == 0);
        let layers: u32 = textures.map(|t| t.texture.depth_or_array_layers()).sum();
        let blank = self.placeholder.texture.depth_or_array_layers();
        (u64::from(layers) * u64::from(self.size).pow(2) + u64::from(blank))
            * texel_bytes(self.format)
    }
}

impl SlotTexture {
    fn new(device: &wgpu::Device, texture: wgpu::Texture, label: &str, first_layer: u32) -> Self {
        Self {
            cube: (!gl::is_gl(device)).then(|| cube_view(&texture, label, first_layer)),
            all: array_view(&texture, label),
            faces: CubeFace::ALL.map(|face| face_view(&texture, label, first_layer, face)),
            texture,
            first_layer,
        }
    }
}

pub(crate) fn create_texture(
    device: &wgpu::Device,
    label: &str,
    size: u32,
    format: wgpu::TextureFormat,
    layers: u32,
) -> wgpu::Texture {
    // Layers of what is static are copied to it.
    let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT
        | wgpu::TextureUsages::TEXTURE_BINDING
        | wgpu::TextureUsages::COPY_DST;
    if format != wgpu::TextureFormat::Depth24Plus {
        usage |= wgpu::TextureUsages::COPY_SRC;
    }
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

fn cube_view(texture: &wgpu::Texture, label: &str, first_layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(wgpu::TextureViewDimension::Cube),
        base_array_layer: first_layer,
        array_layer_count: Some(6),
        ..Default::default()
    })
}

/// All layers of a texture, for receivers.
pub(crate) fn array_view(texture: &wgpu::Texture, label: &str) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

fn face_view(
    texture: &wgpu::Texture,
    label: &str,
    first_layer: u32,
    face: CubeFace,
) -> wgpu::TextureView {
    layer_view(
        texture,
        &format!("{label} {face:?}"),
        first_layer + face.layer(),
    )
}

/// One layer, to draw on.
pub(crate) fn layer_view(texture: &wgpu::Texture, label: &str, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}
