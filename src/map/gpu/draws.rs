//! Instanced draws: one for each mesh on each tile.

use glam::DAffine3;

use super::instances::{Instance, Instances, instance};
use super::pipelines::{PipelineKey, Pipelines};
use crate::map::plan::Slot;
use crate::map::projection::{FlatFrame, NearPlane, clear_of_near};
use crate::map::sides::{CasterSides, Cull};
use crate::mesh::{Caster, CasterMesh};
use crate::scene::Casters;

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
        pass.draw_indexed(0..self.mesh.triangle_count() * 3, 0, 0..self.instance_count);
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
    for run in members.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
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

/// The draws of a flat map's casters, and their instances.
pub(crate) fn draws_of_flat(
    frame: &FlatFrame,
    sides: CasterSides,
    casters: &Casters,
    all: &[Caster],
) -> (Vec<Draw>, Vec<Instance>) {
    let light_from_world = DAffine3::from_translation(-frame.origin.as_dvec3());
    let frustum = frame.frustum();
    let on_map = casters.records().iter().zip(all);
    let on_map = on_map.filter(|(record, _)| frustum.holds(record));
    let (mut members, mut rows) = (Vec::<Member>::new(), Vec::new());
    for (record, caster) in on_map {
        let cull = Cull::of(sides, record, frame.is_clear_of(&record.bounds));
        members.push((record.mesh, cull, rows.len() as u32));
        rows.push(instance(&(light_from_world * caster.transform())));
    }
    let (mut draws, mut instances) = (Vec::new(), Vec::with_capacity(rows.len()));
    batch(&mut members, &rows, casters, &mut instances, &mut draws);
    (draws, instances)
}

/// The draws of all faces of a cube map that the next encode draws.
#[derive(Debug, Default)]
pub(crate) struct DrawLists {
    faces: Vec<[Vec<Draw>; 6]>,
    /// Those of the layers under the faces, where they are drawn.
    layers: Vec<[Vec<Draw>; 6]>,
    instances: Vec<Instance>,
    // Kept only for its memory: those of each face and layer.
    members: [Vec<Member>; 12],
    rows: Vec<Instance>,
}

impl DrawLists {
    pub fn new(slots: usize) -> Self {
        Self {
            faces: (0..slots).map(|_| Default::default()).collect(),
            layers: (0..slots).map(|_| Default::default()).collect(),
            ..Self::default()
        }
    }

    pub fn clear(&mut self) {
        let lists = self.faces.iter_mut().chain(&mut self.layers);
        lists.flatten().for_each(Vec::clear);
        self.instances.clear();
    }

    pub fn of(&self, slot: usize, face: usize) -> &[Draw] {
        &self.faces[slot][face]
    }

    /// What goes on the layer under a face.
    pub fn of_layer(&self, slot: usize, face: usize) -> &[Draw] {
        &self.layers[slot][face]
    }

    pub fn iter(&self) -> impl Iterator<Item = &Draw> {
        self.faces.iter().chain(&self.layers).flatten().flatten()
    }

    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Adds some faces of a slot.
    pub fn add(
        &mut self,
        (index, slot): (usize, &Slot),
        mask: u8,
        near_plane: NearPlane,
        sides: CasterSides,
        (casters, all): (&Casters, &[Caster]),
    ) {
        let Some(light) = slot.light else { return };
        let near = f64::from(near_plane.of_point(&light));
        let light_from_world = DAffine3::from_translation(-light.position.as_dvec3());
        self.rows.clear();
        self.members.iter_mut().for_each(Vec::clear);
        for at in slot.masks().touching(mask) {
            let (caster, record) = (&all[at], &casters.records()[at]);
            let lists = slot.lists(slot.masks().get(at) & mask, record);
            if lists == 0 {
                continue; // all on layers that are there
            }
            let bounds = record.bounds.relative_to(light.position);
            let cull = Cull::of(sides, record, clear_of_near(&bounds, near));
            for (bit, members) in self.members.iter_mut().enumerate() {
                if lists & 1 << bit != 0 {
                    members.push((record.mesh, cull, self.rows.len() as u32));
                }
            }
            self.rows
                .push(instance(&(light_from_world * caster.transform())));
        }
        let lists = self.faces[index].iter_mut().chain(&mut self.layers[index]);
        for (members, draws) in self.members.iter_mut().zip(lists) {
            batch(members, &self.rows, casters, &mut self.instances, draws);
        }
    }
}
