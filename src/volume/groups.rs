//! Bind groups: one set for each mesh and chunk of buffers.

use std::collections::HashMap;

use super::buffers::Buffers;
use super::draw::DrawPipelines;
use super::layout::bind;
use super::params::{BatchParams, CasterParams};
use super::plan::{Batch, Plan};
use super::silhouette::{Extraction, Way};
use crate::mesh::CasterMesh;

/// The bind groups of a mesh with a chunk's buffers.
#[derive(Debug)]
pub(super) struct Group {
    // Keeps the mesh alive, so that its key stays its own.
    _mesh: CasterMesh,
    /// The facing pass and the edge pass, where compute shaders extract.
    pub extraction: Option<[wgpu::BindGroup; 2]>,
    pub draw: wgpu::BindGroup,
}

/// Bind groups by mesh key and chunk.
#[derive(Debug, Default)]
pub(super) struct Groups {
    generation: u64,
    by_key: HashMap<(usize, usize), Group>,
    /// For each batch, its key.
    of_batch: Vec<(usize, usize)>,
}

/// What bind groups are made of.
#[derive(Clone, Copy)]
pub(super) struct Parts<'a> {
    pub device: &'a wgpu::Device,
    pub label: &'a str,
    pub buffers: &'a Buffers,
    pub extraction: Option<&'a Extraction>,
    pub pulled: Option<&'a DrawPipelines>,
    pub fed: Option<&'a DrawPipelines>,
}

impl Groups {
    /// The bind groups of a batch, by its place in the plan.
    pub fn get(&self, batch: usize) -> Option<&Group> {
        self.by_key.get(self.of_batch.get(batch)?)
    }

    /// Brings the bind groups up to date with plan and buffers.
    pub fn update(&mut self, plan: &Plan, parts: &Parts<'_>) {
        let generation = parts.buffers.generation();
        let mut old = std::mem::take(self);
        if old.generation != generation {
            old.by_key.clear();
        }
        self.generation = generation;
        for batch in &plan.batches {
            let key = (batch.mesh.key(), batch.chunk);
            self.of_batch.push(key);
            if self.by_key.contains_key(&key) {
                continue;
            }
            if let Some(group) = old.by_key.remove(&key).or_else(|| parts.group(batch)) {
                self.by_key.insert(key, group);
            }
        }
    }
}

impl Parts<'_> {
    fn group(&self, batch: &Batch) -> Option<Group> {
        let mesh = &batch.mesh;
        let window = (self.buffers.casters()?, size_of::<CasterParams>());
        let draw = match batch.way {
            Way::Vertex => self.bind(&self.fed?.layout, window, &[]),
            Way::Compute | Way::Cpu => {
                let [_, _, sides] = self.buffers.chunk(batch.chunk)?;
                let buffers = [mesh.positions(), mesh.edges(), sides];
                self.bind(&self.pulled?.layout, window, &buffers)
            }
        };
        let extraction = match batch.way {
            Way::Compute => Some(self.extraction_groups(batch)?),
            Way::Cpu | Way::Vertex => None,
        };
        Some(Group {
            _mesh: mesh.clone(),
            extraction,
            draw,
        })
    }

    fn extraction_groups(&self, batch: &Batch) -> Option<[wgpu::BindGroup; 2]> {
        let bound = self.buffers.bound()?;
        let [facings, caps, sides] = self.buffers.chunk(batch.chunk)?;
        let extraction = self.extraction?;
        let mesh = &batch.mesh;
        let params = (bound.batches, size_of::<BatchParams>());
        let (instances, arguments) = (bound.instances, bound.arguments);
        // A closed mesh has no list of uses, and its passes read none; any buffer will do there.
        let uses = mesh.edge_uses().unwrap_or(mesh.edges());
        let (positions, triangles) = (mesh.positions(), mesh.triangles());
        let facing = [instances, arguments, positions, triangles, facings, caps];
        let edges = [instances, arguments, mesh.edges(), uses, facings, sides];
        Some([
            self.bind(&extraction.facing.layout, params, &facing),
            self.bind(&extraction.edges.layout, params, &edges),
        ])
    }

    fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        window: (&wgpu::Buffer, usize),
        buffers: &[&wgpu::Buffer],
    ) -> wgpu::BindGroup {
        bind(self.device, self.label, layout, window, buffers)
    }
}
