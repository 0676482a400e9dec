//! Bind groups: one set for each mesh and chunk of buffers.

use std::collections::HashMap;

use crate::mesh::CasterMesh;
use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_pipelines::DrawPipelines;
use crate::volume::gpu::layout::bind;
use crate::volume::plan::cache::{Kept, Slot};
use crate::volume::plan::faces::{Batch, Plan};
use crate::volume::plan::params::{BatchParams, CasterParams};
use crate::volume::silhouette::{Extraction, Way};

/// Mesh and chunk.
type Key = (u64, usize);

/// Bind groups by mesh and chunk.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    generation: u64,
    draw: HashMap<Key, wgpu::BindGroup>,
    /// The facing pass and the edge pass.
    extraction: HashMap<Key, [wgpu::BindGroup; 2]>,
    /// For each caster that is drawn, what its draws read.
    of_caster: Vec<Option<wgpu::BindGroup>>,
}

/// What bind groups are made of.
#[derive(Clone, Copy)]
pub(crate) struct Parts<'a> {
    pub device: &'a wgpu::Device,
    pub label: &'a str,
    pub buffers: &'a Buffers,
    pub extraction: Option<&'a Extraction>,
    pub pulled: Option<&'a DrawPipelines>,
    pub fed: Option<&'a DrawPipelines>,
}

impl Groups {
    /// What the draws of a caster read, by its place in the plan.
    pub fn of_caster(&self, place: usize) -> Option<&wgpu::BindGroup> {
        self.of_caster.get(place)?.as_ref()
    }

    /// The facing pass and the edge pass of a batch.
    pub fn of_batch(&self, batch: &Batch) -> Option<&[wgpu::BindGroup; 2]> {
        self.extraction.get(&(batch.mesh.id(), batch.chunk))
    }

    /// Brings the bind groups up to date with plan and buffers.
    pub fn update(&mut self, plan: &Plan, kept: &Kept, parts: &Parts<'_>) {
        let generation = parts.buffers.generation();
        let mut old = std::mem::take(self);
        if old.generation != generation {
            old.draw.clear();
            old.extraction.clear();
        }
        self.generation = generation;
        for slot in plan.slot_of.iter().map(|&slot| kept.get(slot)) {
            let group = slot.and_then(|slot| self.draw_group(slot, &mut old, parts));
            self.of_caster.push(group);
        }
        for batch in &plan.batches {
            let key = (batch.mesh.id(), batch.chunk);
            if self.extraction.contains_key(&key) {
                continue;
            }
            let group = old.extraction.remove(&key);
            if let Some(group) = group.or_else(|| parts.extraction(&batch.mesh, batch.chunk)) {
                self.extraction.insert(key, group);
            }
        }
        // What need not be searched in this frame may move in the next.
        let drawn = |(key, _): &(Key, _)| self.draw.contains_key(key);
        self.extraction
            .extend(old.extraction.into_iter().filter(drawn));
    }

    fn draw_group(
        &mut self,
        slot: &Slot,
        old: &mut Self,
        parts: &Parts<'_>,
    ) -> Option<wgpu::BindGroup> {
        let key = (slot.mesh.id(), slot.place.chunk);
        if let Some(group) = self.draw.get(&key) {
            return Some(group.clone());
        }
        let group = old.draw.remove(&key).or_else(|| parts.draw(slot))?;
        self.draw.insert(key, group.clone());
        Some(group)
    }
}

impl Parts<'_> {
    fn draw(&self, slot: &Slot) -> Option<wgpu::BindGroup> {
        let window = (self.buffers.casters()?, size_of::<CasterParams>());
        match slot.way {
            Way::Vertex => Some(self.bind(&self.fed?.layout, window, &[])),
            Way::Compute | Way::Cpu => {
                let [_, _, sides] = self.buffers.chunk(slot.place.chunk)?;
                let buffers = [slot.mesh.positions(), slot.mesh.edges()?, sides];
                Some(self.bind(&self.pulled?.layout, window, &buffers))
            }
        }
    }

    fn extraction(&self, mesh: &CasterMesh, chunk: usize) -> Option<[wgpu::BindGroup; 2]> {
        let bound = self.buffers.bound()?;
        let [facings, caps, sides] = self.buffers.chunk(chunk)?;
        let extraction = self.extraction?;
        let params = (bound.batches, size_of::<BatchParams>());
        let (instances, arguments) = (bound.instances, bound.arguments);
        // A closed mesh has no list of uses, and its passes read none; any buffer will do there.
        let edges = mesh.edges()?;
        let uses = mesh.edge_uses().unwrap_or(edges);
        let (positions, triangles) = (mesh.positions(), mesh.triangles());
        let facing = [instances, arguments, positions, triangles, facings, caps];
        let edges = [instances, arguments, edges, uses, facings, sides];
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
