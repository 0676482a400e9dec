//! Instanced draws: one for each mesh on each tile.

use glam::Vec3;

use super::instances::{Instance, Instances, instance_around};
use super::pipelines::{PipelineKey, Pipelines};
use crate::map::plan::{DrawMode, Slot, tiles_of};
use crate::map::projection::{MOST_TILES, NearPlane, TileProjection};
use crate::map::sides::{CasterSides, Cull};
use crate::mesh::{Caster, CasterMesh};
use crate::scene::{Block, CasterBounds, Casters, Record};

/// One draw call: a mesh, and where its instances lie.
#[derive(Clone, Debug)]
pub(crate) struct Draw {
    mesh: CasterMesh,
    cull: Option<wgpu::Face>,
    first_instance: u64,
    instance_count: u32,
}

impl Draw {
    /// The pipeline it needs.
    pub fn key(&self) -> PipelineKey {
        PipelineKey {
            stride: self.mesh.layout().0,
            cull: self.cull,
            places: self
                .mesh
                .places()
                .map(|places| (places.layout, places.stride)),
        }
    }

    pub fn triangles(&self) -> u64 {
        u64::from(self.mesh.triangle_count()) * u64::from(self.instance_count)
    }

    /// Records it into a depth pass.
    pub fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipelines: &Pipelines,
        instances: &Instances,
    ) {
        let Some(pipeline) = pipelines.get(&self.key()) else {
            return; // prepare made one for every key
        };
        let (_, offset) = self.mesh.layout();
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, self.mesh.positions().slice(offset..));
        // Sliced rather than drawn from a first instance, which GL does not have.
        let instances = instances.slice(self.first_instance, self.instance_count);
        pass.set_vertex_buffer(1, instances);
        let (indices, format) = self.mesh.indices();
        pass.set_index_buffer(indices, format);
        let mut count = self.instance_count;
        if let Some(places) = self.mesh.places() {
            pass.set_vertex_buffer(2, places.buffer.slice(places.offset..));
            count = places.count;
        }
        pass.draw_indexed(0..self.mesh.index_count(), 0, 0..count);
    }
}

/// Casters of a tile that follow each other in the host's list and are drawn alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Run {
    /// The place of their mesh, and what of it is culled.
    alike: (u32, Cull),
    first: u32,
    count: u32,
}

/// Adds casters to a list, to its last run if they continue it.
fn push(runs: &mut Vec<Run>, run: Run) {
    match runs.last_mut() {
        Some(last) if last.alike == run.alike && last.first + last.count == run.first => {
            last.count += run.count;
        }
        _ => runs.push(run),
    }
}

/// Instances that follow each other in the buffer: casters, seen from a light.
#[derive(Clone, Copy, Debug)]
struct Rows {
    origin: Vec3,
    first: u32,
    count: u32,
}

/// The instances of all draws, in order.
#[derive(Debug, Default)]
struct AllRows {
    rows: Vec<Rows>,
    count: u64,
}

impl AllRows {
    /// Makes draws of the casters of a tile, seen from `origin`.
    fn batch(&mut self, runs: &mut [Run], origin: Vec3, casters: &Casters, draws: &mut Vec<Draw>) {
        runs.sort_unstable();
        for alike in runs.chunk_by(|a, b| a.alike == b.alike) {
            let (mesh, cull) = alike[0].alike;
            let Some(mesh) = casters.mesh(mesh) else {
                continue; // the mesh of every record is there
            };
            let first = self.count;
            for &Run { first, count, .. } in alike {
                let rows = Rows {
                    origin,
                    first,
                    count,
                };
                self.rows.push(rows);
                self.count += u64::from(count);
            }
            // What the host places is drawn caster by caster.
            let most = match mesh.places() {
                Some(_) => 1,
                None => u64::from(u32::MAX),
            };
            let mut at = first;
            while at < self.count {
                let count = most.min(self.count - at);
                draws.push(Draw {
                    mesh: mesh.clone(),
                    cull: cull.face(),
                    first_instance: at,
                    instance_count: count as u32,
                });
                at += count;
            }
        }
    }
}

/// What is drawn on one tile, and on the layer under it.
#[derive(Clone, Debug, Default)]
pub(crate) struct TileDraws {
    pub tile: ListedDraws,
    pub layer: ListedDraws,
}

/// Draws in one pass: those of the map, and the places of casters that the host draws.
#[derive(Clone, Debug, Default)]
pub(crate) struct ListedDraws {
    pub draws: Vec<Draw>,
    pub host: Vec<usize>,
}

impl ListedDraws {
    const NONE: Self = Self {
        draws: Vec::new(),
        host: Vec::new(),
    };

    pub fn is_empty(&self) -> bool {
        self.draws.is_empty() && self.host.is_empty()
    }
}

/// The draws of all tiles of a map that the next encode draws.
#[derive(Debug, Default)]
pub(crate) struct DrawLists {
    /// By slot; empty where nothing is drawn.
    slots: Vec<Vec<TileDraws>>,
    rows: AllRows,
    // Kept only for its memory: those of each tile and layer.
    runs: [[Vec<Run>; 2]; MOST_TILES],
}

impl DrawLists {
    pub fn clear(&mut self) {
        self.slots.iter_mut().for_each(Vec::clear);
        self.rows.rows.clear();
        self.rows.count = 0;
    }

    /// What is drawn on a tile of a slot.
    pub fn of(&self, slot: usize, tile: usize) -> &TileDraws {
        const NONE: &TileDraws = &TileDraws {
            tile: ListedDraws::NONE,
            layer: ListedDraws::NONE,
        };
        let tiles = self.slots.get(slot);
        tiles.and_then(|tiles| tiles.get(tile)).unwrap_or(NONE)
    }

    pub fn iter(&self) -> impl Iterator<Item = &Draw> {
        let tiles = self.slots.iter().flatten();
        tiles.flat_map(|draws| draws.tile.draws.iter().chain(&draws.layer.draws))
    }

    /// Instances of all draws.
    pub fn instance_count(&self) -> u64 {
        self.rows.count
    }

    /// The instances of all draws, in order.
    pub fn instances<'a>(&'a self, all: &'a [Caster]) -> impl Iterator<Item = Instance> + 'a {
        self.rows.rows.iter().flat_map(move |rows| {
            let first = rows.first as usize;
            let casters = &all[first..first + rows.count as usize];
            casters
                .iter()
                .map(|caster| instance_around(rows.origin, &caster.world_from_object))
        })
    }

    /// Adds some tiles of a slot.
    pub fn add(
        &mut self,
        (index, slot): (usize, &Slot),
        drawn: u8,
        near_plane: NearPlane,
        sides: CasterSides,
        casters: &Casters,
    ) {
        let Some(light) = slot.light() else { return };
        if self.slots.len() <= index {
            self.slots.resize_with(index + 1, Vec::new);
        }
        self.slots[index].clear();
        self.slots[index].resize_with(light.count(), TileDraws::default);
        let projections: [_; MOST_TILES] = std::array::from_fn(|tile| match drawn & 1 << tile {
            0 => None,
            _ => slot.projection(tile),
        });
        let seen = Seen {
            slot: (index, slot),
            drawn,
            projections,
            near_plane,
            sides,
        };
        self.runs.iter_mut().flatten().for_each(Vec::clear);
        for (block, touching) in slot.masks().touching_blocks() {
            if !self.add_block(&seen, block, casters) {
                touching.for_each(|at| self.add_caster(&seen, at, &casters.records()[at]));
            }
        }
        let projections = &seen.projections;
        let tiles = self.slots[index].iter_mut().zip(&mut self.runs);
        for ((draws, runs), projection) in tiles.zip(projections) {
            let Some(projection) = projection else {
                continue;
            };
            for (listed, runs) in [&mut draws.tile, &mut draws.layer].into_iter().zip(runs) {
                self.rows
                    .batch(runs, projection.origin(), casters, &mut listed.draws);
            }
        }
    }

    fn add_caster(&mut self, seen: &Seen<'_>, at: usize, record: &Record) {
        let (index, slot) = seen.slot;
        for tile in tiles_of(slot.masks().get(at) & seen.drawn) {
            let (in_tile, in_layer) = slot.lists(tile, record);
            if record.host_drawn {
                let draws = &mut self.slots[index][tile];
                draws.tile.host.extend(in_tile.then_some(at));
                draws.layer.host.extend(in_layer.then_some(at));
                continue;
            }
            let run = Run {
                alike: (record.mesh, seen.cull(tile, record, &record.bounds)),
                first: at as u32,
                count: 1,
            };
            for (listed, runs) in [in_tile, in_layer].into_iter().zip(&mut self.runs[tile]) {
                if listed {
                    push(runs, run);
                }
            }
        }
    }

    /// False if the casters of a block must be looked at one by one.
    fn add_block(&mut self, seen: &Seen<'_>, index: usize, casters: &Casters) -> bool {
        let (_, slot) = seen.slot;
        let block = casters.blocks().get(index).filter(|block| block.alike);
        let (Some(block), Some(mask)) = (block, slot.masks().of_block(index)) else {
            return false;
        };
        let mask = mask & seen.drawn;
        if tiles_of(mask).any(|tile| !seen.is_all_one(tile, &block.bounds)) {
            return false;
        }
        let first = index * Block::SIZE;
        let record = &casters.records()[first];
        for tile in tiles_of(mask) {
            let run = Run {
                alike: (record.mesh, seen.cull(tile, record, &block.bounds)),
                first: first as u32,
                count: Block::SIZE as u32,
            };
            push(&mut self.runs[tile][0], run);
        }
        true
    }
}

/// A slot's tiles that are drawn, and how.
struct Seen<'a> {
    slot: (usize, &'a Slot),
    drawn: u8,
    /// Of those that are drawn.
    projections: [Option<TileProjection>; MOST_TILES],
    near_plane: NearPlane,
    sides: CasterSides,
}

impl Seen<'_> {
    /// Which triangles of a caster are dropped that lies within some bounds.
    fn cull(&self, tile: usize, record: &Record, bounds: &CasterBounds) -> Cull {
        Cull::of(self.sides, record, || self.is_clear(tile, bounds))
    }

    fn is_clear(&self, tile: usize, bounds: &CasterBounds) -> bool {
        let clear = |of: &TileProjection| of.is_clear_of(bounds, self.near_plane);
        self.projections[tile].as_ref().is_some_and(clear)
    }

    /// Whether casters within some bounds that are alike go to the same list, and have the same
    /// triangles dropped.
    fn is_all_one(&self, tile: usize, bounds: &CasterBounds) -> bool {
        let (_, slot) = self.slot;
        slot.tiles[tile].layer.mode() == DrawMode::Whole && self.is_clear(tile, bounds)
    }
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};

    use super::*;
    use crate::PointLight;
    use crate::map::encoding::DepthEncoding;
    use crate::map::plan::{Reached, Slot};
    use crate::map::projection::LightProjection;
    use crate::mesh::Adjacency;

    /// Two closed meshes in turns of eleven, some mirrored, some around the light.
    fn casters(device: &wgpu::Device) -> Vec<Caster> {
        let positions = [
            [0.0, 0.0, 0.0],
            [0.4, 0.0, 0.0],
            [0.0, 0.4, 0.0],
            [0.0, 0.0, 0.4],
        ];
        let indices = [0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3];
        let meshes = [(); 2].map(|()| {
            let adjacency = Adjacency::new(&positions, &indices).unwrap();
            CasterMesh::new(device, &positions, &adjacency).unwrap()
        });
        let place = |i: usize| {
            let at = Vec3::new(
                (i % 30) as f32 * 0.7 - 10.0,
                0.1,
                (i / 30) as f32 * 0.7 - 10.0,
            );
            let scale = Vec3::ONE.with_x(if i / 40 % 4 == 3 { -1.0 } else { 1.0 });
            let map = Affine3A::from_scale_rotation_translation(scale, glam::Quat::IDENTITY, at);
            Caster::new(meshes[i / 11 % 2].clone(), map)
        };
        (0..901).map(place).collect()
    }

    #[test]
    fn each_draw_has_the_casters_of_its_tile_that_are_drawn_like_it() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let all = casters(&device);
        let mut casters = Casters::default();
        casters.compare(&all, &device).unwrap();
        casters.update(&all);
        let light = LightProjection::Point(PointLight::new(Vec3::new(0.2, 0.3, 0.1), 50.0));
        let mut slot = Slot::new(true);
        slot.leave_light(Some(&light));
        slot.set_light(light.clone().into(), &casters, Reached::All);
        let near = NearPlane::new(wgpu::TextureFormat::Depth32Float, DepthEncoding::MajorAxis);
        let mut lists = DrawLists::default();
        lists.add((0, &slot), slot.all(), near, CasterSides::Nearest, &casters);
        let instances: Vec<Instance> = lists.instances(&all).collect();
        assert_eq!(instances.len() as u64, lists.instance_count());
        let (mut seen, mut others) = (0, 0);
        for tile in 0..6 {
            let projection = slot.projection(tile).unwrap();
            // Caster by caster, in the order of meshes and then of the list.
            let of_tile = |tile: usize| {
                let on = (0..all.len()).filter(|&at| slot.masks().get(at) & 1 << tile != 0);
                let mut on: Vec<_> = on
                    .map(|at| {
                        let record = &casters.records()[at];
                        let clear = || projection.is_clear_of(&record.bounds, near);
                        (
                            record.mesh,
                            Cull::of(CasterSides::Nearest, record, clear),
                            at,
                        )
                    })
                    .collect();
                on.sort_unstable();
                on
            };
            let drawn = |expected: &[(u32, Cull, usize)]| {
                let mut expected = expected.iter();
                lists.of(0, tile).tile.draws.iter().all(|draw| {
                    let first = draw.first_instance as usize;
                    instances[first..first + draw.instance_count as usize]
                        .iter()
                        .all(|row| {
                            expected.next().is_some_and(|&(mesh, cull, at)| {
                                let place = &all[at].world_from_object;
                                casters.mesh(mesh).map(CasterMesh::id) == Some(draw.mesh.id())
                                    && cull.face() == draw.cull
                                    && *row == instance_around(projection.origin(), place)
                            })
                        })
                }) && expected.next().is_none()
            };
            assert!(drawn(&of_tile(tile)), "tile {tile}");
            seen += of_tile(tile).len();
            // The broken twin: the casters of the opposite face (up and down the same few touch both).
            others += usize::from(!drawn(&of_tile(tile ^ 1)));
        }
        assert!(seen > 900 && others == 4, "{seen} {others}");
    }
}
