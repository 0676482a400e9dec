//! Instanced draws: one for each mesh on each face.

use std::collections::HashMap;

use glam::DAffine3;

use super::descriptor::CasterSides;
use super::near::NearPlane;
use super::resources::{INSTANCE_SIZE, Instance, PipelineKey};
use super::scene::{Record, Scene, Winding};
use super::slot::{Slot, bounds};
use super::statistics::CubeStatistics;
use crate::mesh::{Caster, CasterMesh};

/// One draw call: a mesh, and where its instances lie.
#[derive(Clone, Debug)]
pub(super) struct Draw {
    pub mesh: CasterMesh,
    pub cull: Option<wgpu::Face>,
    pub first_instance: u64,
    pub instance_count: u32,
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
        pipelines: &HashMap<PipelineKey, wgpu::RenderPipeline>,
        instances: &wgpu::Buffer,
    ) {
        let Some(pipeline) = pipelines.get(&self.key()) else {
            return; // prepare made one for every key
        };
        let (_, offset) = self.mesh.layout();
        let count = self.instance_count;
        let size = u64::from(count) * INSTANCE_SIZE;
        let first = self.first_instance * INSTANCE_SIZE;
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, self.mesh.positions().slice(offset..));
        // Sliced rather than drawn from a first instance, which GL does not have.
        pass.set_vertex_buffer(1, instances.slice(first..first + size));
        pass.set_index_buffer(self.mesh.triangles().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.mesh.triangle_count() * 3, 0, 0..count);
    }
}

/// Which triangles of a caster the rasteriser drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Cull {
    None,
    Front,
    Back,
}

impl Cull {
    /// `clear`: the light is outside the caster's bounds and the near plane does not cut them.
    pub fn of(sides: CasterSides, record: &Record, clear: bool) -> Self {
        let far = sides == CasterSides::Far;
        if !far && !clear {
            return Self::None; // the light may be inside, or the near plane cut the nearest side
        }
        // The faces' frames are left-handed: what is counter-clockwise seen from the light is
        // clockwise (a back face) on the map, unless the transform mirrors it once more.
        match (record.winding, far) {
            (Winding::Any, _) => Self::None,
            (Winding::Sound, false) | (Winding::Mirrored, true) => Self::Front,
            (Winding::Sound, true) | (Winding::Mirrored, false) => Self::Back,
        }
    }

    pub fn face(self) -> Option<wgpu::Face> {
        match self {
            Self::None => None,
            Self::Front => Some(wgpu::Face::Front),
            Self::Back => Some(wgpu::Face::Back),
        }
    }
}

/// The draws of all faces that the next encode draws.
#[derive(Debug, Default)]
pub(super) struct DrawLists {
    faces: Vec<[Vec<Draw>; 6]>,
    /// Those of the layers under the faces, where they are drawn.
    layers: Vec<[Vec<Draw>; 6]>,
    pub instances: Vec<Instance>,
    // Kept only for its memory: group, culling and row of each caster on each face and layer.
    members: [Vec<(u32, Cull, u32)>; 12],
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

    /// Counts draw calls and the triangles in them.
    pub fn count(&self, statistics: &mut CubeStatistics) {
        for draw in self.iter() {
            statistics.draws += 1;
            statistics.triangles += draw.triangles();
        }
    }

    /// Adds some faces of a slot.
    pub fn add(
        &mut self,
        index: usize,
        slot: &Slot,
        mask: u8,
        near_plane: NearPlane,
        scene: &Scene,
        casters: &[Caster],
    ) {
        let Some(light) = slot.light else { return };
        let near = f64::from(near_plane.of_point(&light));
        let light_from_world = DAffine3::from_translation(-light.position.as_dvec3());
        self.rows.clear();
        self.members.iter_mut().for_each(Vec::clear);
        for at in slot.masks().touching(mask) {
            let (caster, record) = (&casters[at], &scene.records()[at]);
            let lists = slot.lists(slot.masks().get(at) & mask, record);
            if lists == 0 {
                continue; // all on layers that are there
            }
            let clear = bounds(&light, record).clear_of_near(near);
            let cull = Cull::of(scene.sides(), record, clear);
            for (bit, members) in self.members.iter_mut().enumerate() {
                if lists & 1 << bit != 0 {
                    members.push((record.group, cull, self.rows.len() as u32));
                }
            }
            self.rows
                .push(instance(&(light_from_world * caster.transform())));
        }
        let lists = self.faces[index].iter_mut().chain(&mut self.layers[index]);
        for (members, draws) in self.members.iter_mut().zip(lists) {
            members.sort_unstable();
            for run in members.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
                let Some(group) = scene.group(run[0].0) else {
                    continue; // every record's group exists
                };
                draws.push(Draw {
                    mesh: group.mesh.clone(),
                    cull: run[0].1.face(),
                    first_instance: self.instances.len() as u64,
                    instance_count: run.len() as u32,
                });
                let rows = run.iter().map(|&(.., row)| self.rows[row as usize]);
                self.instances.extend(rows);
            }
        }
    }
}

pub(super) fn instance(light_from_object: &DAffine3) -> Instance {
    let linear = light_from_object.matrix3.transpose();
    let offset = light_from_object.translation;
    [
        linear.x_axis.extend(offset.x).as_vec4().to_array(),
        linear.y_axis.extend(offset.y).as_vec4().to_array(),
        linear.z_axis.extend(offset.z).as_vec4().to_array(),
    ]
}
