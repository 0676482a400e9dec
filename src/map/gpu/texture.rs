//! The textures of a cube map, made when the first light casts.

use crate::gl;
use crate::map::encoding::texel_bytes;
use crate::map::projection::CubeFace;

/// One light's six layers.
#[derive(Debug)]
pub(crate) struct SlotTexture {
    pub texture: wgpu::Texture,
    pub first_layer: u32,
    pub cube: wgpu::TextureView,
    pub faces: [wgpu::TextureView; 6],
}

/// A texture for all lights, or one for each, or none yet.
#[derive(Debug)]
pub(crate) struct CubeTextures {
    label: String,
    size: u32,
    format: wgpu::TextureFormat,
    slots: Vec<Option<SlotTexture>>,
    array: Option<Array>,
    /// A texel for each face, bound as long as there is nothing else.
    placeholder: wgpu::TextureView,
    /// The faces of the placeholder, and whether they are clear.
    blank: [wgpu::TextureView; 6],
    blank_is_clear: bool,
    blank_layers: u32,
    revision: u64,
}

#[derive(Debug)]
struct Array {
    /// More than there are lights where the device would else take it for something else.
    cubes: u32,
    /// Whether a light's part of it can be read as a cube by itself.
    has_cubes: bool,
    placeholder: wgpu::TextureView,
    view: Option<wgpu::TextureView>,
}

impl CubeTextures {
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        size: u32,
        format: wgpu::TextureFormat,
        slots: usize,
        array: bool,
    ) -> Self {
        let cubes = |lights| match array {
            true => gl::array_cubes(device, lights),
            false => 1,
        };
        let placeholder = create_texture(device, label, 1, format, 6 * cubes(1));
        Self {
            label: label.to_owned(),
            size,
            format,
            slots: (0..slots).map(|_| None).collect(),
            array: array.then(|| Array {
                cubes: cubes(slots as u32),
                has_cubes: !gl::is_gl(device),
                placeholder: array_view(&placeholder, label),
                view: None,
            }),
            blank_layers: placeholder.depth_or_array_layers(),
            blank: CubeFace::ALL.map(|face| face_view(&placeholder, label, 0, face)),
            blank_is_clear: false,
            placeholder: cube_view(&placeholder, label, 0),
            revision: 0,
        }
    }

    /// Makes what a slot needs. Gives the slots whose texels are new.
    pub fn allocate(&mut self, device: &wgpu::Device, slot: usize) -> std::ops::Range<usize> {
        if self.slots[slot].is_some() {
            return 0..0;
        }
        self.revision += 1;
        let label = self.label.clone();
        let Some(array) = &mut self.array else {
            let texture = create_texture(device, &label, self.size, self.format, 6);
            self.slots[slot] = Some(SlotTexture::new(texture, &label, 0));
            return slot..slot + 1;
        };
        let texture = create_texture(device, &label, self.size, self.format, 6 * array.cubes);
        array.view = Some(array_view(&texture, &label));
        for (slot, first_layer) in self.slots.iter_mut().zip((0..).step_by(6)) {
            *slot = Some(SlotTexture::new(texture.clone(), &label, first_layer));
        }
        0..self.slots.len()
    }

    /// Gives a slot's texels back; false if it had none. An array goes with the first of its slots,
    /// so all must be freed.
    pub fn free(&mut self, slot: usize) -> bool {
        let had = self.slots[slot].take().is_some();
        self.revision += u64::from(had);
        if let Some(array) = &mut self.array {
            array.view = None;
        }
        had
    }

    pub fn slot(&self, slot: usize) -> Option<&SlotTexture> {
        self.slots.get(slot)?.as_ref()
    }

    /// A light's cube, or a placeholder; `None` if it cannot be read by itself.
    pub fn cube(&self, slot: usize) -> Option<&wgpu::TextureView> {
        let cube = self.slot(slot).map_or(&self.placeholder, |slot| &slot.cube);
        let readable = self.array.as_ref().is_none_or(|array| array.has_cubes);
        readable.then_some(cube)
    }

    /// The faces of the placeholder, until they are said to be clear.
    pub fn to_be_cleared(&self) -> &[wgpu::TextureView] {
        match self.blank_is_clear {
            true => &[],
            false => &self.blank,
        }
    }

    /// Learns that the placeholder is clear.
    pub fn placeholder_cleared(&mut self) {
        self.blank_is_clear = true;
    }

    /// Nothing is known of the placeholder's texels any more.
    pub fn doubt(&mut self) {
        self.blank_is_clear = false;
    }

    /// All lights' cubes, or a placeholder; `None` if each has a texture of its own.
    pub fn array(&self) -> Option<&wgpu::TextureView> {
        let array = self.array.as_ref()?;
        Some(array.view.as_ref().unwrap_or(&array.placeholder))
    }

    pub fn revision(&self) -> u64 {
        self.revision
    }

    pub fn bytes(&self) -> u64 {
        let textures = self.slots.iter().flatten();
        let textures = textures.filter(|slot| slot.first_layer == 0);
        let layers: u32 = textures.map(|t| t.texture.depth_or_array_layers()).sum();
        let blank = self.blank_layers;
        (u64::from(layers) * u64::from(self.size).pow(2) + u64::from(blank))
            * texel_bytes(self.format)
    }
}

impl SlotTexture {
    fn new(texture: wgpu::Texture, label: &str, first_layer: u32) -> Self {
        Self {
            cube: cube_view(&texture, label, first_layer),
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

fn array_view(texture: &wgpu::Texture, label: &str) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(wgpu::TextureViewDimension::CubeArray),
        ..Default::default()
    })
}

fn face_view(
    texture: &wgpu::Texture,
    label: &str,
    first_layer: u32,
    face: CubeFace,
) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(&format!("{label} {face:?}")),
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: first_layer + face.layer(),
        array_layer_count: Some(1),
        ..Default::default()
    })
}
