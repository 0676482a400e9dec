//! Instanced draws: one for each mesh on each face.

use std::collections::HashMap;

use glam::DAffine3;

use super::resources::{INSTANCE_SIZE, Instance, PipelineKey};
use super::scene::Scene;
use super::slot::Slot;
use crate::mesh::{Caster, CasterMesh};

/// One draw call: a mesh, and where its instances lie.
#[derive(Clone, Debug)]
pub(super) struct Draw {
    pub mesh: CasterMesh,
    pub mirrored: Option<bool>,
    pub first_instance: u64,
    pub instance_count: u32,
}

impl Draw {
    /// The pipeline it needs.
    pub fn key(&self) -> PipelineKey {
        PipelineKey {
            stride: self.mesh.layout().0,
            mirrored: self.mirrored,
        }
    }

    /// Records it into a depth pass.
    pub fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipelines: &HashMap<PipelineKey, wgpu::RenderPipeline>,
        instances: &wgpu::Buffer,
    ) {
        let (_, offset) = self.mesh.layout();
        let Some(pipeline) = pipelines.get(&self.key()) else {
            return; // prepare made one for every key
        };
        let size = u64::from(self.instance_count) * INSTANCE_SIZE;
        let first = self.first_instance * INSTANCE_SIZE;
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, self.mesh.positions().slice(offset..));
        // Sliced rather than drawn from a first instance, which GL does not have.
        pass.set_vertex_buffer(1, instances.slice(first..first + size));
        pass.set_index_buffer(self.mesh.triangles().slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.mesh.triangle_count() * 3, 0, 0..self.instance_count);
    }
}

/// The draws of all faces that the next encode draws.
#[derive(Debug, Default)]
pub(super) struct DrawLists {
    faces: Vec<[Vec<Draw>; 6]>,
    pub instances: Vec<Instance>,
    // Kept only for its memory: group and row of each caster on the face at hand.
    members: [Vec<(u32, u32)>; 6],
    rows: Vec<Instance>,
}

impl DrawLists {
    pub fn new(slots: usize) -> Self {
        Self {
            faces: (0..slots).map(|_| Default::default()).collect(),
            ..Self::default()
        }
    }

    pub fn clear(&mut self) {
        self.faces.iter_mut().flatten().for_each(Vec::clear);
        self.instances.clear();
    }

    pub fn of(&self, slot: usize, face: usize) -> &[Draw] {
        &self.faces[slot][face]
    }

    pub fn iter(&self) -> impl Iterator<Item = &Draw> {
        self.faces.iter().flatten().flatten()
    }

    /// Adds some faces of a slot.
    pub fn add(&mut self, index: usize, slot: &Slot, mask: u8, scene: &Scene, casters: &[Caster]) {
        let Some(light) = slot.light else { return };
        let light_from_world = DAffine3::from_translation(-light.position.as_dvec3());
        self.rows.clear();
        self.members.iter_mut().for_each(Vec::clear);
        for ((touched, caster), record) in slot.masks().iter().zip(casters).zip(scene.records()) {
            let on = touched & mask;
            if on == 0 {
                continue;
            }
            for (bit, members) in self.members.iter_mut().enumerate() {
                if on & 1 << bit != 0 {
                    members.push((record.group, self.rows.len() as u32));
                }
            }
            self.rows
                .push(instance(&(light_from_world * caster.transform())));
        }
        for (members, draws) in self.members.iter_mut().zip(&mut self.faces[index]) {
            members.sort_unstable();
            for run in members.chunk_by(|a, b| a.0 == b.0) {
                let Some(group) = scene.group(run[0].0) else {
                    continue; // every record's group exists
                };
                draws.push(Draw {
                    mesh: group.mesh.clone(),
                    mirrored: group.mirrored,
                    first_instance: self.instances.len() as u64,
                    instance_count: run.len() as u32,
                });
                let rows = run.iter().map(|&(_, row)| self.rows[row as usize]);
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
