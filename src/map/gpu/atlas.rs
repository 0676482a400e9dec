//! All that an atlas has on the GPU.

use super::atlas_lights::AtlasLights;
use super::atlas_texture::{AtlasTexture, Resized};
use super::casting::{Casting, DrawnTile};
use super::draws::{DrawLists, ListedDraws};
use super::encode::begin_depth_pass;
use super::host_draw::DrawByHost;
use super::instances::TooLarge;
use super::light_record::TilePlace;
use super::pipelines::{PipelineKind, can_pull_casters};
use super::tile_fill::TileFill;
use crate::map::encoding::DepthEncoding;
use crate::map::plan::{DrawMode, Place, Residents, Slot, Slots};
use crate::map::projection::{MOST_TILES, NearPlane};
use crate::map::sides::CasterSides;
use crate::mesh::Caster;
use crate::scene::Casters;
use crate::uploads::Uploads;

/// What an atlas is made for.
pub(crate) struct AtlasKind {
    pub label: String,
    /// Texels along a side of a layer.
    pub layer_size: u32,
    pub format: wgpu::TextureFormat,
    pub slope_scale: f32,
    pub sides: CasterSides,
}

/// Texture, pipelines, buffers, and what the next encode records.
#[derive(Debug)]
pub(crate) struct AtlasGpu {
    label: String,
    texture: AtlasTexture,
    fill: TileFill,
    lights: AtlasLights,
    casting: Casting,
}

/// The lights whose tiles are drawn.
pub(crate) struct Tiled<'a> {
    pub slots: &'a Slots,
    pub residents: &'a Residents,
    /// Light and view of each slot.
    pub names: &'a [(usize, usize)],
}

/// A tile that the next encode draws.
#[derive(Clone, Copy, Debug)]
struct Pending {
    slot: usize,
    tile: usize,
    place: Place,
}

impl AtlasGpu {
    pub fn new(device: &wgpu::Device, kind: AtlasKind) -> Self {
        let AtlasKind {
            label,
            layer_size,
            format,
            slope_scale,
            sides,
        } = kind;
        let encoding = DepthEncoding::MajorAxis;
        let kind = PipelineKind {
            format,
            encoding,
            slope_scale,
            unclipped_depth: can_pull_casters(device),
        };
        Self {
            texture: AtlasTexture::new(device, &label, layer_size, format),
            fill: TileFill::new(device, &label, format),
            lights: AtlasLights::new(device, &label),
            casting: Casting::new(device, &label, kind, sides, (0, MOST_TILES)),
            label,
        }
    }

    pub fn texture(&self) -> &AtlasTexture {
        &self.texture
    }

    pub fn lights(&self) -> &AtlasLights {
        &self.lights
    }

    pub fn lights_mut(&mut self) -> (&mut AtlasLights, &mut Uploads) {
        (&mut self.lights, self.casting.uploads())
    }

    pub fn draws(&self) -> &DrawLists {
        self.casting.draws()
    }

    pub fn near_plane(&self) -> NearPlane {
        self.casting.near_plane()
    }

    /// Whether casters before the near plane are pulled onto it.
    pub fn unclipped_depth(&self) -> bool {
        self.casting.unclipped_depth()
    }

    /// Bytes that the next encode copies.
    pub fn uploaded(&self) -> u64 {
        self.casting.uploaded()
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        self.texture.bytes() + self.casting.bytes() + self.lights.buffer().size()
    }

    /// Makes as many layers as are needed, and room for the records of lights.
    pub fn resize(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layers: u32,
        records: usize,
    ) -> Resized {
        let resized = self.texture.resize(device, layers);
        let revision = self.texture.revision();
        self.lights.reserve(device, queue, records, revision);
        resized
    }

    /// Checks that one buffer of the device holds the matrices of so many slots.
    pub fn check_slots(&self, device: &wgpu::Device, slots: usize) -> Result<(), TooLarge> {
        self.casting.check_slots(device, slots)
    }

    /// Makes room for so many instances, and for the matrices of so many slots.
    pub fn reserve(
        &mut self,
        device: &wgpu::Device,
        instances: usize,
        slots: usize,
    ) -> Result<(), TooLarge> {
        self.casting.reserve(device, instances, slots)
    }

    pub fn clear_draws(&mut self) {
        self.casting.clear();
    }

    /// Lists what the pending tiles of a slot show. `layer_least`: for texels along a tile the fewest
    /// triangles that are worth a static layer.
    pub fn add_tiles(
        &mut self,
        device: &wgpu::Device,
        (index, slot): (usize, &mut Slot),
        places: &[Place],
        layer_least: &impl Fn(u32) -> Option<u64>,
        casters: &Casters,
    ) {
        let drawn = slot.pending;
        let size = places.first().map_or(0, |place| place.size);
        if let Some(least) = layer_least(size) {
            slot.choose_modes(drawn, least, casters);
            for (tile, place) in slot.tiles.iter().zip(places) {
                if matches!(tile.layer.mode(), DrawMode::Build(_)) {
                    let fill = &self.fill;
                    let source = |view: &wgpu::TextureView| fill.source(device, view);
                    self.texture.make_statics(device, place.layer, source);
                }
            }
        }
        self.casting.add((index, slot), drawn, size, casters);
    }

    /// Stages what the listed draws of some of all casters need.
    pub fn finish_draws(&mut self, device: &wgpu::Device, all: &[Caster]) {
        self.casting.finish(device, all);
    }

    /// Forgets what was to be written, and what has been.
    pub fn forget_uploads(&mut self) {
        self.casting.forget_uploads();
        self.lights.forget();
    }

    /// Nothing is known of what encodes have recorded any more.
    pub fn doubt(&mut self) {
        self.texture.doubt();
        self.forget_uploads();
    }

    /// Records the uploads, and the copy of what a texture of another size held; whether there were any.
    pub fn upload(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        self.texture.carry_over(encoder) | self.casting.uploads().record(encoder)
    }

    /// The pending tiles of a slot that lack what only the host can draw, if it is not asked.
    pub fn incomplete(&self, slot: (usize, &Slot)) -> Vec<usize> {
        self.casting.incomplete(slot)
    }

    /// Draws the pending tiles, those of a layer in one pass.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        tiled: &Tiled<'_>,
        mut by_host: Option<DrawByHost<'_>>,
    ) {
        let slots = tiled.slots.iter().enumerate();
        let mut pending: Vec<Pending> = slots
            .flat_map(|(index, slot)| pending_tiles(index, slot, tiled.residents))
            .collect();
        pending.sort_by_key(|tile| tile.place.layer);
        for tiles in pending.chunk_by(|a, b| a.place.layer == b.place.layer) {
            self.encode_statics(encoder, tiled, tiles, &mut by_host);
            self.encode_layer(encoder, tiled, tiles, &mut by_host);
        }
    }

    /// Draws what is static on some tiles of a layer, where that is to be copied.
    fn encode_statics(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        tiled: &Tiled<'_>,
        tiles: &[Pending],
        by_host: &mut Option<DrawByHost<'_>>,
    ) {
        let built = |tile: &&Pending| matches!(tile.mode(tiled), DrawMode::Build(_));
        let built: Vec<&Pending> = tiles.iter().filter(built).collect();
        let layer = tiles[0].place.layer;
        let Some(statics) = self.texture.statics(layer).filter(|_| !built.is_empty()) else {
            return;
        };
        let label = format!("{} static layer {layer}", self.label);
        let mut pass = begin_depth_pass(encoder, &label, &statics.view, wgpu::LoadOp::Load);
        for tile in built {
            set_tile(&mut pass, tile.place);
            self.fill.clear(&mut pass);
            let draws = &self.casting.draws().of(tile.slot, tile.tile).layer;
            self.record(&mut pass, tiled, tile, draws, by_host);
        }
    }

    fn encode_layer(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        tiled: &Tiled<'_>,
        tiles: &[Pending],
        by_host: &mut Option<DrawByHost<'_>>,
    ) {
        let layer = tiles[0].place.layer;
        let Some(view) = self.texture.layer(layer) else {
            return; // prepare made a layer wherever there is a tile
        };
        // Where all of a layer is drawn anew nothing of it need be read: it is cleared at once, if that is
        // not for a small part of it.
        let texels: u64 = tiles.iter().map(|tile| tile.place.texels()).sum();
        let whole = tiles.len() == tiled.residents.count_in(layer)
            && 2 * texels >= self.texture.layer_texels();
        let load = match whole {
            true => wgpu::LoadOp::Clear(DepthEncoding::MajorAxis.clear_depth()),
            false => wgpu::LoadOp::Load,
        };
        let label = format!("{} layer {layer}", self.label);
        let mut pass = begin_depth_pass(encoder, &label, view, load);
        for tile in tiles {
            set_tile(&mut pass, tile.place);
            match (tile.mode(tiled), self.texture.statics(layer)) {
                (DrawMode::Copy(_) | DrawMode::Build(_), Some(statics)) => {
                    self.fill.copy(&mut pass, &statics.source);
                }
                _ if !whole => self.fill.clear(&mut pass),
                _ => {}
            }
            let draws = &self.casting.draws().of(tile.slot, tile.tile).tile;
            self.record(&mut pass, tiled, tile, draws, by_host);
        }
    }

    fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        tiled: &Tiled<'_>,
        tile: &Pending,
        listed: &ListedDraws,
        by_host: &mut Option<DrawByHost<'_>>,
    ) {
        let drawn = DrawnTile {
            slot: &tiled.slots[tile.slot],
            index: tile.slot,
            tile: tile.tile,
            name: tiled.names[tile.slot],
            size: tile.place.size,
        };
        self.casting.record(pass, &drawn, listed, by_host);
    }
}

impl Pending {
    fn mode(&self, tiled: &Tiled<'_>) -> DrawMode {
        tiled.slots[self.slot].tiles[self.tile].layer.mode()
    }
}

fn pending_tiles<'a>(
    slot: usize,
    of: &'a Slot,
    residents: &'a Residents,
) -> impl Iterator<Item = Pending> + 'a {
    let places = residents.places(slot).iter().enumerate();
    let drawn = places.filter(|(tile, _)| of.pending & 1 << tile != 0);
    drawn.map(move |(tile, &place)| Pending { slot, tile, place })
}

/// Confines what is drawn to a tile.
fn set_tile(pass: &mut wgpu::RenderPass<'_>, place: Place) {
    let Place { x, y, size, .. } = place;
    pass.set_viewport(x as f32, y as f32, size as f32, size as f32, 0.0, 1.0);
    pass.set_scissor_rect(x, y, size, size);
}

impl From<Place> for TilePlace {
    fn from(place: Place) -> Self {
        let Place { x, y, layer, .. } = place;
        Self { x, y, layer }
    }
}
