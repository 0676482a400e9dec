//! All that a cube map has on the GPU.

use super::casting::Casting;
use super::cube_lights::CubeLights;
use super::draws::{Draw, DrawLists};
use super::encode::begin_depth_pass;
use super::instances::TooLarge;
use super::light_record::{LightRecord, TilePlace, TileTexture, Tiles};
use super::pipelines::{PipelineKind, can_pull_casters};
use super::static_layers::StaticLayerTextures;
use super::texture::CubeTextures;
use crate::map::cube_descriptor::CubeShadowMapDescriptor;
use crate::map::encoding::DepthEncoding;
use crate::map::plan::{DrawMode, Slot, Slots};
use crate::map::projection::{CubeFace, NearPlane, TileProjection};
use crate::mesh::Caster;
use crate::scene::Casters;
use crate::{Bias, PointLight};

/// Textures, pipelines, buffers, and what the next encode records.
#[derive(Debug)]
pub(crate) struct CubeGpu {
    label: String,
    size: u32,
    bias: Bias,
    format: wgpu::TextureFormat,
    encoding: DepthEncoding,
    textures: CubeTextures,
    layers: StaticLayerTextures,
    lights: CubeLights,
    casting: Casting,
}

impl CubeGpu {
    pub fn new(device: &wgpu::Device, descriptor: &CubeShadowMapDescriptor<'_>) -> Self {
        let &CubeShadowMapDescriptor {
            size,
            bias,
            cube_array,
            format,
            encoding,
            ..
        } = descriptor;
        let slots = descriptor.lights as usize;
        let label = match descriptor.label {
            Some(label) => format!("shadows cube map {label}"),
            None => "shadows cube map".to_owned(),
        };
        let kind = PipelineKind {
            format,
            encoding,
            slope_scale: bias.slope_scale,
            unclipped_depth: can_pull_casters(device),
        };
        let textures = CubeTextures::new(device, &label, size, format, slots, cube_array);
        Self {
            size,
            bias,
            format,
            encoding,
            lights: CubeLights::new(device, &label, slots, cube_array, textures.revision()),
            textures,
            layers: StaticLayerTextures::new(&label, size, format, slots),
            casting: Casting::new(device, &label, kind, descriptor.sides, (slots, 6)),
            label,
        }
    }

    pub fn textures(&self) -> &CubeTextures {
        &self.textures
    }

    pub fn lights(&self) -> &CubeLights {
        &self.lights
    }

    pub fn draws(&self) -> &DrawLists {
        self.casting.draws()
    }

    pub fn near_plane(&self) -> NearPlane {
        self.casting.near_plane()
    }

    /// Bytes that the next encode copies.
    pub fn uploaded(&self) -> u64 {
        self.casting.uploaded()
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        self.textures.bytes() + self.layers.bytes() + self.casting.bytes() + self.lights.bytes()
    }

    /// Makes the texels of a slot. Gives the slots whose texels are new.
    pub fn allocate(&mut self, device: &wgpu::Device, slot: usize) -> std::ops::Range<usize> {
        self.textures.allocate(device, slot)
    }

    /// Gives a slot's texels back; false if it had none.
    pub fn free(&mut self, slot: usize) -> bool {
        self.layers.free(slot);
        self.textures.free(slot)
    }

    /// Gives the lights other buffers if bind groups must be made again.
    pub fn replace_lights(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, revision: u64) {
        self.lights.replace(device, queue, revision);
    }

    /// Makes room for so many instances.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) -> Result<(), TooLarge> {
        let slots = self.textures.slots();
        self.casting.reserve(device, count, slots)
    }

    pub fn clear_draws(&mut self) {
        self.casting.clear();
    }

    /// Lists what some faces of a slot show. `layer_least`: the fewest triangles that are worth a
    /// static layer.
    pub fn add_faces(
        &mut self,
        device: &wgpu::Device,
        (index, slot): (usize, &mut Slot),
        drawn: u8,
        layer_least: Option<u64>,
        (casters, all): (&Casters, &[Caster]),
    ) {
        if let Some(least) = layer_least {
            slot.choose_modes(drawn, least, casters);
            for (bit, face) in slot.tiles.iter().enumerate() {
                let built = matches!(face.layer.mode(), DrawMode::Build(_));
                if drawn & 1 << bit != 0 && built {
                    self.layers.make(device, index, bit);
                }
            }
        }
        let casters = (casters, all);
        self.casting.add((index, slot), drawn, self.size, casters);
    }

    /// Stages what the listed draws need.
    pub fn finish_draws(&mut self, device: &wgpu::Device) {
        self.casting.finish(device);
    }

    /// Stages what receivers are told of the lights. `marks_casterless`: whether they are told of
    /// lights without casters, whose texels then do not count.
    pub fn write_lights(&mut self, lights: &[PointLight], slots: &Slots, marks_casterless: bool) {
        let texture = TileTexture {
            side: self.size,
            bias: self.bias,
            format: self.format,
        };
        for ((place, wanted), &index) in lights.iter().enumerate().zip(slots.order()) {
            let slot = &slots[index];
            let shown = shown_light(slot);
            let light = shown.unwrap_or(*wanted);
            let near = self.casting.near_plane().of_point(&light);
            let casterless = marks_casterless && slot.casting == 0 && shown == Some(*wanted);
            let record = |tiles| LightRecord::point(&light, near, tiles, &texture);
            let record = match self.textures.slot(index) {
                Some(_) if shown.is_none() => LightRecord::DARK,
                Some(layers) if !casterless => record(Tiles::At {
                    size: self.size,
                    places: CubeFace::ALL
                        .map(|face| TilePlace::layer(layers.first_layer + face.layer())),
                }),
                _ => record(Tiles::NoCaster),
            };
            self.lights.write(self.casting.uploads(), place, record);
        }
    }

    /// Forgets what was to be written, and what has been.
    pub fn forget_uploads(&mut self) {
        self.casting.forget_uploads();
        self.lights.forget();
    }

    /// Nothing is known of what encodes have recorded any more.
    pub fn doubt(&mut self) {
        self.textures.doubt();
        self.forget_uploads();
    }

    /// Records the uploads; whether there were any.
    pub fn upload(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        self.casting.uploads().record(encoder)
    }

    /// Clears what is bound in the place of texels that are not there, once; whether it did.
    pub fn clear_placeholder(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        let views = self.textures.to_be_cleared();
        for view in views {
            drop(begin_depth_pass(encoder, &self.label, view, self.clear()));
        }
        let any = !views.is_empty();
        self.textures.placeholder_cleared();
        any
    }

    /// Draws the pending faces of a slot, each in its pass.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, index: usize, slot: &Slot) {
        for face in CubeFace::ALL {
            if slot.pending & face.bit() != 0 {
                self.encode_face(encoder, index, slot, face);
            }
        }
    }

    /// Draws one face over what is static on it.
    fn encode_face(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        slot: &Slot,
        face: CubeFace,
    ) {
        let draws = &self
            .casting
            .draws()
            .of(index, face.layer() as usize)
            .tile
            .draws;
        let load = match self.encode_layer(encoder, index, slot, face) {
            true if draws.is_empty() => return,
            true => wgpu::LoadOp::Load,
            false => self.clear(),
        };
        // Prepare made the texture of every slot with pending faces.
        if let Some(mut pass) = self.begin_face(encoder, index, face, load) {
            self.record(&mut pass, index, face, draws);
        }
    }

    /// Copies the layer under a face, drawn first if need be. False if the face is drawn whole.
    fn encode_layer(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        slot: &Slot,
        face: CubeFace,
    ) -> bool {
        let Some(view) = self.layers.view(index, face) else {
            return false; // prepare made a layer wherever there is a mode that needs one
        };
        match slot.tiles[face.layer() as usize].layer.mode() {
            DrawMode::Whole => return false,
            DrawMode::Build(_) => {
                let label = self.face_label(index, face);
                let mut pass = begin_depth_pass(encoder, &label, view, self.clear());
                let draws = &self
                    .casting
                    .draws()
                    .of(index, face.layer() as usize)
                    .layer
                    .draws;
                self.record(&mut pass, index, face, draws);
            }
            DrawMode::Copy(_) => {}
        }
        self.layers.copy(encoder, index, face, &self.textures);
        true
    }

    fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        index: usize,
        face: CubeFace,
        draws: &[Draw],
    ) {
        let tile = (index, face.layer() as usize);
        self.casting.record(pass, tile, draws);
    }

    /// Begins a pass on a face of a slot, if it has texels.
    pub fn begin_face<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        index: usize,
        face: CubeFace,
        load: wgpu::LoadOp<f32>,
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let view = &self.textures.slot(index)?.faces[face.layer() as usize];
        let label = self.face_label(index, face);
        Some(begin_depth_pass(encoder, &label, view, load))
    }

    pub fn clear(&self) -> wgpu::LoadOp<f32> {
        wgpu::LoadOp::Clear(self.encoding.clear_depth())
    }

    fn face_label(&self, index: usize, face: CubeFace) -> String {
        format!("{} {index} {face:?}", self.label)
    }
}

/// The light that receivers are told of.
pub(crate) fn shown_light(slot: &Slot) -> Option<PointLight> {
    match slot.tiles.first()?.shown? {
        TileProjection::Face(light) => Some(light),
        TileProjection::Flat(_) => None,
    }
}
