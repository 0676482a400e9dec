//! All that a map of one light has on the GPU: a texture with a layer for each of its tiles.

use super::casting::{Casting, DrawnTile};
use super::draws::{DrawLists, ListedDraws};
use super::encode::begin_depth_pass;
use super::host_draw::DrawByHost;
use super::instances::TooLarge;
use super::light_buffer::LightBuffer;
use super::light_record::{LightRecord, TilePlace, TileTexture, Tiles};
use super::pipelines::PipelineKind;
use super::static_layers::StaticLayerTextures;
use super::texture::{array_view, create_texture, layer_view};
use crate::Bias;
use crate::gl;
use crate::map::encoding::{DepthEncoding, texel_bytes};
use crate::map::plan::{DrawMode, Slot};
use crate::map::projection::NearPlane;
use crate::map::sides::CasterSides;
use crate::mesh::Caster;
use crate::scene::Casters;

/// What such a map is made for.
pub(crate) struct OneLightKind {
    pub label: String,
    /// Texels along a side of a tile.
    pub size: u32,
    pub tiles: u32,
    pub bias: Bias,
    pub pipelines: PipelineKind,
    pub sides: CasterSides,
}

/// Texture, pipelines, buffers, and what the next encode records.
#[derive(Debug)]
pub(crate) struct OneLightGpu {
    label: String,
    size: u32,
    bias: Bias,
    encoding: DepthEncoding,
    texture: wgpu::Texture,
    /// What is drawn on, a layer each, and what is read: all of them.
    tiles: Vec<wgpu::TextureView>,
    layers: wgpu::TextureView,
    statics: StaticLayerTextures,
    light: LightBuffer,
    casting: Casting,
}

impl OneLightGpu {
    pub fn new(device: &wgpu::Device, kind: OneLightKind) -> Self {
        let OneLightKind {
            label,
            size,
            tiles,
            bias,
            pipelines,
            sides,
        } = kind;
        let (format, encoding) = (pipelines.format, pipelines.encoding);
        let layers = gl::array_layers(device, tiles);
        let texture = create_texture(device, &label, size, format, layers);
        let count = tiles as usize;
        Self {
            size,
            bias,
            encoding,
            tiles: (0..tiles)
                .map(|tile| layer_view(&texture, &format!("{label} {tile}"), tile))
                .collect(),
            layers: array_view(&texture, &label),
            texture,
            statics: StaticLayerTextures::new(&label, size, format, count),
            light: LightBuffer::new(device, &label),
            casting: Casting::new(device, &label, pipelines, sides, (1, count)),
            label,
        }
    }

    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }

    /// One tile, to be drawn on.
    pub fn tile(&self, tile: usize) -> &wgpu::TextureView {
        &self.tiles[tile]
    }

    /// All tiles, to be read.
    pub fn layers(&self) -> &wgpu::TextureView {
        &self.layers
    }

    /// What receivers are told of the light.
    pub fn light(&self) -> &wgpu::Buffer {
        self.light.buffer()
    }

    pub fn size(&self) -> u32 {
        self.size
    }

    pub fn encoding(&self) -> DepthEncoding {
        self.encoding
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
        let texels = u64::from(self.texture.depth_or_array_layers()) * u64::from(self.size).pow(2);
        texels * texel_bytes(self.texture.format())
            + self.statics.bytes()
            + self.casting.bytes()
            + self.light.buffer().size()
    }

    /// How receivers find texels, and by what these are biased.
    pub fn tile_texture(&self) -> TileTexture {
        TileTexture {
            side: self.size,
            bias: self.bias,
            format: self.texture.format(),
        }
    }

    /// Where the tiles are, for receivers: each fills its layer.
    pub fn places<const N: usize>(&self) -> Tiles<N> {
        debug_assert_eq!(N, self.tiles.len());
        Tiles::At {
            size: self.size,
            places: std::array::from_fn(|tile| TilePlace::layer(tile as u32)),
        }
    }

    /// Makes room for so many instances.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) -> Result<(), TooLarge> {
        self.casting.reserve(device, count, 1)
    }

    /// Lists what the pending tiles show, and stages what drawing that needs. `layer_least`: the fewest
    /// triangles that are worth a static layer.
    pub fn list(
        &mut self,
        device: &wgpu::Device,
        slot: &mut Slot,
        layer_least: Option<u64>,
        (casters, all): (&Casters, &[Caster]),
    ) {
        self.casting.clear();
        let drawn = slot.pending;
        if drawn != 0 {
            if let Some(least) = layer_least {
                slot.choose_modes(drawn, least, casters);
                for (bit, tile) in slot.tiles.iter().enumerate() {
                    let built = matches!(tile.layer.mode(), DrawMode::Build(_));
                    if drawn & 1 << bit != 0 && built {
                        self.statics.make(device, bit);
                    }
                }
            }
            self.casting.add((0, slot), drawn, self.size, casters);
        }
        self.casting.finish(device, all);
    }

    /// Stages what receivers are told of the light.
    pub fn write_light(&mut self, record: LightRecord) {
        self.light.write(self.casting.uploads(), record);
    }

    /// Forgets what was to be written, and what has been.
    pub fn forget_uploads(&mut self) {
        self.casting.forget_uploads();
        self.light.forget();
    }

    /// Records the uploads; whether there were any.
    pub fn upload(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        self.casting.uploads().record(encoder)
    }

    /// The pending tiles that lack what only the host can draw, if it is not asked.
    pub fn incomplete(&self, slot: &Slot) -> Vec<usize> {
        self.casting.incomplete((0, slot))
    }

    /// Draws the pending tiles, each in its pass.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: &Slot,
        mut by_host: Option<DrawByHost<'_>>,
    ) {
        for tile in (0..slot.tiles.len()).filter(|tile| slot.pending & 1 << tile != 0) {
            self.encode_tile(encoder, slot, tile, &mut by_host);
        }
    }

    /// Draws one tile over what is static on it.
    fn encode_tile(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: &Slot,
        tile: usize,
        by_host: &mut Option<DrawByHost<'_>>,
    ) {
        let listed = &self.casting.draws().of(0, tile).tile;
        let load = match self.encode_static(encoder, slot, tile, by_host) {
            true if listed.is_empty() => return,
            true => wgpu::LoadOp::Load,
            false => self.clear(),
        };
        let label = format!("{} {tile}", self.label);
        let mut pass = begin_depth_pass(encoder, &label, &self.tiles[tile], load);
        self.record(&mut pass, (slot, tile), listed, by_host);
    }

    /// Copies the static layer under a tile, drawn first if need be. False if the tile is drawn whole.
    fn encode_static(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: &Slot,
        tile: usize,
        by_host: &mut Option<DrawByHost<'_>>,
    ) -> bool {
        let Some(view) = self.statics.view(tile) else {
            return false; // prepare made one wherever there is a mode that needs it
        };
        match slot.tiles[tile].layer.mode() {
            DrawMode::Whole => return false,
            DrawMode::Build(_) => {
                let label = format!("{} {tile} static", self.label);
                let mut pass = begin_depth_pass(encoder, &label, view, self.clear());
                let listed = &self.casting.draws().of(0, tile).layer;
                self.record(&mut pass, (slot, tile), listed, by_host);
            }
            DrawMode::Copy(_) => {}
        }
        self.statics.copy(encoder, tile, &self.texture);
        true
    }

    fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        (slot, tile): (&Slot, usize),
        listed: &ListedDraws,
        by_host: &mut Option<DrawByHost<'_>>,
    ) {
        let drawn = DrawnTile {
            slot,
            index: 0,
            tile,
            name: (0, 0),
            size: self.size,
        };
        self.casting.record(pass, &drawn, listed, by_host);
    }

    fn clear(&self) -> wgpu::LoadOp<f32> {
        wgpu::LoadOp::Clear(self.encoding.clear_depth())
    }
}
