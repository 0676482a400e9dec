//! The passes that draw tiles: the casters of each, and then its mip levels.

use super::descriptor::Projector;
use super::draws::{Draw, INSTANCE_SIZE, Instance, list};
use super::pipelines::{CasterPipelines, TilePipelines, TileSquare};
use super::texture::MipTexture;
use crate::map::{FlatFrame, Place, buffer};
use crate::uploads::Uploads;

const VERTEX: wgpu::BufferUsages = wgpu::BufferUsages::VERTEX;

/// What casters are drawn with, and which tiles the next encode draws.
#[derive(Debug)]
pub(super) struct Passes {
    label: String,
    casters: CasterPipelines,
    tiles: TilePipelines,
    /// Each level of the texture, to be halved.
    sources: Vec<wgpu::BindGroup>,
    instances: wgpu::Buffer,
    squares: wgpu::Buffer,
    /// Layer by layer, those of a layer from the largest to the smallest.
    pending: Vec<Pending>,
    // Kept only for its memory.
    rows: Vec<Instance>,
}

/// One tile that is drawn.
#[derive(Debug)]
struct Pending {
    place: Place,
    draws: Vec<Draw>,
}

impl Passes {
    pub fn new(device: &wgpu::Device, label: &str, texture: &MipTexture) -> Self {
        let mut passes = Self {
            casters: CasterPipelines::new(device, label),
            tiles: TilePipelines::new(device, label),
            sources: Vec::new(),
            instances: buffer(device, label, INSTANCE_SIZE, VERTEX),
            squares: buffer(device, label, size_of::<TileSquare>() as u64, VERTEX),
            pending: Vec::new(),
            rows: Vec::new(),
            label: label.to_owned(),
        };
        passes.read_from(device, texture);
        passes
    }

    /// Learns that the texture is another one.
    pub fn read_from(&mut self, device: &wgpu::Device, texture: &MipTexture) {
        let levels = texture.levels().iter();
        self.sources = levels
            .map(|level| self.tiles.source(device, level))
            .collect();
    }

    /// Forgets the tiles that were listed.
    pub fn clear(&mut self) {
        self.pending.clear();
        self.rows.clear();
    }

    /// Lists a projector's tile.
    pub fn add(&mut self, frame: &FlatFrame, place: Place, projector: &Projector<'_>) {
        let mut draws = Vec::new();
        list(frame, projector, &mut self.rows, &mut draws);
        self.pending.push(Pending { place, draws });
    }

    /// Stages what the listed tiles need, for a texture whose layers have so many texels along a side.
    pub fn finish(&mut self, device: &wgpu::Device, uploads: &mut Uploads, layer_size: u32) {
        self.pending.sort_by_key(|tile| {
            let Place { layer, x, y, size } = tile.place;
            (layer, std::cmp::Reverse(size), y, x)
        });
        let draws = self.pending.iter().flat_map(|tile| &tile.draws);
        self.casters.make(device, draws.map(Draw::key));
        let step = 1.0 / layer_size as f32;
        let square = |tile: &Pending| -> TileSquare {
            let Place { layer, x, y, size } = tile.place;
            let [x, y, side] = [x, y, size].map(|texels| texels as f32 * step);
            [x, y, side, layer as f32]
        };
        let squares: Vec<TileSquare> = self.pending.iter().map(square).collect();
        let label = &self.label;
        stage(
            device,
            uploads,
            label,
            &mut self.instances,
            bytemuck::cast_slice(&self.rows),
        );
        stage(
            device,
            uploads,
            label,
            &mut self.squares,
            bytemuck::cast_slice(&squares),
        );
    }

    /// Whether the next encode draws.
    pub fn is_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    pub fn draws(&self) -> impl Iterator<Item = &Draw> {
        self.pending.iter().flat_map(|tile| &tile.draws)
    }

    /// Passes of the next encode.
    pub fn count(&self) -> u32 {
        self.layers()
            .map(|(_, tiles)| 1 + tiles[0].place.size.ilog2())
            .sum()
    }

    pub fn bytes(&self) -> u64 {
        self.instances.size() + self.squares.size()
    }

    /// Draws the listed tiles.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, texture: &MipTexture) {
        for (first, tiles) in self.layers() {
            self.draw_casters(encoder, texture, (first, tiles));
            self.halve(encoder, texture, (first, tiles));
        }
    }

    /// The tiles of each layer, with the place of the first of them.
    fn layers(&self) -> impl Iterator<Item = (usize, &[Pending])> {
        let runs = self.pending.chunk_by(|a, b| a.place.layer == b.place.layer);
        runs.scan(0, |next, run| {
            let first = *next;
            *next += run.len();
            Some((first, run))
        })
    }

    fn begin<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
    ) -> wgpu::RenderPass<'encoder> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        })
    }

    /// Covers so many tiles, from a place in the list on.
    fn cover(&self, pass: &mut wgpu::RenderPass<'_>, first: usize, count: usize) {
        // Sliced rather than drawn from a first instance, which GL does not have.
        let stride = size_of::<TileSquare>() as u64;
        let (first, count) = (first as u64, count as u64);
        let squares = first * stride..(first + count) * stride;
        pass.set_vertex_buffer(0, self.squares.slice(squares));
        pass.draw(0..4, 0..count as u32);
    }

    fn draw_casters(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &MipTexture,
        (first, tiles): (usize, &[Pending]),
    ) {
        let Some(target) = texture.target(tiles[0].place.layer, 0) else {
            return; // prepare made a layer wherever there is a tile
        };
        let mut pass = self.begin(encoder, target);
        pass.set_pipeline(&self.tiles.clear);
        self.cover(&mut pass, first, tiles.len());
        for tile in tiles {
            let Place { x, y, size, .. } = tile.place;
            pass.set_viewport(x as f32, y as f32, size as f32, size as f32, 0.0, 1.0);
            pass.set_scissor_rect(x, y, size, size);
            for draw in &tile.draws {
                self.record(&mut pass, draw);
            }
        }
    }

    fn record(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw) {
        let Some(pipeline) = self.casters.get(&draw.key()) else {
            return; // prepare made one for every key
        };
        let (_, offset) = draw.mesh.layout();
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, draw.mesh.positions().slice(offset..));
        let (first, mut count) = (draw.first_instance, draw.instance_count);
        let rows = first * INSTANCE_SIZE..(first + u64::from(count)) * INSTANCE_SIZE;
        pass.set_vertex_buffer(1, self.instances.slice(rows));
        let (indices, format) = draw.mesh.indices();
        pass.set_index_buffer(indices, format);
        if let Some(places) = draw.mesh.places() {
            pass.set_vertex_buffer(2, places.buffer.slice(places.offset..));
            count = places.count;
        }
        pass.draw_indexed(0..draw.mesh.index_count(), 0, 0..count);
    }

    /// Makes the mip levels of a layer's tiles: each tile's by itself, as it is a power of two at a multiple of its
    /// size.
    fn halve(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &MipTexture,
        (first, tiles): (usize, &[Pending]),
    ) {
        for level in 1..=tiles[0].place.size.ilog2() {
            let Some(target) = texture.target(tiles[0].place.layer, level) else {
                return;
            };
            let count = tiles.partition_point(|tile| tile.place.size >> level > 0);
            let mut pass = self.begin(encoder, target);
            pass.set_pipeline(&self.tiles.halve);
            pass.set_bind_group(0, &self.sources[level as usize - 1], &[]);
            self.cover(&mut pass, first, count);
        }
    }
}

/// Uploads bytes into a buffer that is made larger if it must be.
fn stage(
    device: &wgpu::Device,
    uploads: &mut Uploads,
    label: &str,
    to: &mut wgpu::Buffer,
    bytes: &[u8],
) {
    let size = bytes.len() as u64;
    if size > to.size() {
        let room = size
            .next_power_of_two()
            .min(device.limits().max_buffer_size);
        *to = buffer(device, label, room, VERTEX);
    }
    uploads.write(to, 0, bytes);
}
