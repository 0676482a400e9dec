//! Instanced draws: one for each mesh on each tile.

use glam::DAffine3;

use super::instances::{Instance, Instances, instance};
use super::pipelines::{PipelineKey, Pipelines};
use crate::map::plan::Slot;
use crate::map::projection::{MOST_TILES, NearPlane};
use crate::map::sides::{CasterSides, Cull};
use crate::mesh::{Caster, CasterMesh};
use crate::scene::{Casters, Record};

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

/// One caster of a tile: the place of its mesh, what of it is culled, and its row.
type Member = (u32, Cull, u32);

/// Makes draws of the casters of a tile, whose instances are among `rows`.
fn batch(
    members: &mut [Member],
    rows: &[Instance],
    casters: &Casters,
    instances: &mut Vec<Instance>,
    draws: &mut Vec<Draw>,
) {
    members.sort_unstable();
    let many_places = |mesh: u32| {
        casters
            .mesh(mesh)
            .is_some_and(|mesh| mesh.places().is_some())
    };
    for run in members.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1) && !many_places(a.0)) {
        let Some(mesh) = casters.mesh(run[0].0) else {
            continue; // the mesh of every record is there
        };
        draws.push(Draw {
            mesh: mesh.clone(),
            cull: run[0].1.face(),
            first_instance: instances.len() as u64,
            instance_count: run.len() as u32,
        });
        instances.extend(run.iter().map(|&(.., row)| rows[row as usize]));
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
    instances: Vec<Instance>,
    // Kept only for its memory: those of each tile and layer.
    members: [[Vec<Member>; 2]; MOST_TILES],
    rows: Vec<Instance>,
}

impl DrawLists {
    pub fn clear(&mut self) {
        self.slots.iter_mut().for_each(Vec::clear);
        self.instances.clear();
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

    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Adds some tiles of a slot.
    pub fn add(
        &mut self,
        (index, slot): (usize, &Slot),
        drawn: u8,
        near_plane: NearPlane,
        sides: CasterSides,
        (casters, all): (&Casters, &[Caster]),
    ) {
        let Some(light) = slot.light() else { return };
        if self.slots.len() <= index {
            self.slots.resize_with(index + 1, Vec::new);
        }
        self.slots[index].clear();
        self.slots[index].resize_with(light.count(), TileDraws::default);
        let tiles = (0..light.count()).filter(|tile| drawn & 1 << tile != 0);
        // Tiles of one origin share the rows of their casters.
        match light.is_joint() {
            true => self.add_tiles((index, slot), drawn, near_plane, sides, (casters, all)),
            false => tiles.for_each(|tile| {
                self.add_tiles((index, slot), 1 << tile, near_plane, sides, (casters, all));
            }),
        }
    }

    fn add_tiles(
        &mut self,
        (index, slot): (usize, &Slot),
        mask: u8,
        near_plane: NearPlane,
        sides: CasterSides,
        (casters, all): (&Casters, &[Caster]),
    ) {
        let first = mask.trailing_zeros() as usize;
        let Some(projection) = slot.projection(first) else {
            return;
        };
        let light_from_world = DAffine3::from_translation(-projection.origin().as_dvec3());
        self.rows.clear();
        self.members.iter_mut().flatten().for_each(Vec::clear);
        for at in slot.masks().touching(mask) {
            let (caster, record) = (&all[at], &casters.records()[at]);
            if record.host_drawn {
                self.add_host_drawn((index, slot), at, mask, record);
                continue;
            }
            let clear = projection.is_clear_of(&record.bounds, near_plane);
            let member = (
                record.mesh,
                Cull::of(sides, record, clear),
                self.rows.len() as u32,
            );
            let on = slot.masks().get(at) & mask;
            let mut listed = false;
            for (tile, [on_tile, on_layer]) in self.members.iter_mut().enumerate() {
                if on & 1 << tile != 0 {
                    let (in_tile, in_layer) = slot.lists(tile, record);
                    on_tile.extend(in_tile.then_some(member));
                    on_layer.extend(in_layer.then_some(member));
                    listed |= in_tile | in_layer;
                }
            }
            if listed {
                self.rows
                    .push(instance(&(light_from_world * caster.transform())));
            }
        }
        for (draws, members) in self.slots[index].iter_mut().zip(&mut self.members) {
            for (listed, members) in [&mut draws.tile, &mut draws.layer].into_iter().zip(members) {
                let draws = &mut listed.draws;
                batch(members, &self.rows, casters, &mut self.instances, draws);
            }
        }
    }

    fn add_host_drawn(
        &mut self,
        (index, slot): (usize, &Slot),
        caster: usize,
        mask: u8,
        record: &Record,
    ) {
        let on = slot.masks().get(caster) & mask;
        for (tile, draws) in self.slots[index].iter_mut().enumerate() {
            if on & 1 << tile != 0 {
                let (in_tile, in_layer) = slot.lists(tile, record);
                draws.tile.host.extend(in_tile.then_some(caster));
                draws.layer.host.extend(in_layer.then_some(caster));
            }
        }
    }
}
