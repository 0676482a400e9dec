//! Bind groups: one set for each mesh and chunk of buffers.

use std::collections::HashMap;

use crate::mesh::CasterMesh;
use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_pipelines::UNIFORM_SIZES;
use crate::volume::gpu::layout::bind;
use crate::volume::gpu::pipelines::OwnPipelines;
use crate::volume::plan::batches::{Batch, Batches};
use crate::volume::plan::cache::{MeshChunk, Slot, VolumeCache};
use crate::volume::plan::params::BatchParams;
use crate::volume::plan::windows::Windows;
use crate::volume::silhouette::Way;

/// Bind groups by mesh and chunk.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    generation: u64,
    draw: HashMap<MeshChunk, wgpu::BindGroup>,
    /// The facing pass and the edge pass.
    extraction: HashMap<MeshChunk, [wgpu::BindGroup; 2]>,
    /// For each window, what its draws read.
    of_window: Vec<Option<wgpu::BindGroup>>,
}

/// What bind groups are made of.
#[derive(Clone, Copy)]
pub(crate) struct Parts<'a> {
    pub device: &'a wgpu::Device,
    pub label: &'a str,
    pub buffers: &'a Buffers,
    pub pipelines: &'a OwnPipelines,
}

impl Groups {
    /// What the draws of a window read.
    pub fn of_window(&self, number: u32) -> Option<&wgpu::BindGroup> {
        self.of_window.get(number as usize)?.as_ref()
    }

    /// The facing pass and the edge pass of a batch.
    pub fn of_batch(&self, batch: &Batch) -> Option<&[wgpu::BindGroup; 2]> {
        self.extraction.get(&(batch.mesh.id(), batch.chunk))
    }

    /// Brings the bind groups up to date: those of windows that changed, and all if buffers were made
    /// anew.
    pub fn update(
        &mut self,
        (windows, changed): (&Windows, &[u32]),
        batches: &Batches,
        cache: &VolumeCache,
        parts: &Parts<'_>,
    ) {
        let generation = parts.buffers.generation();
        if self.generation != generation {
            self.generation = generation;
            self.draw.clear();
            self.extraction.clear();
            self.of_window.clear();
            self.of_window.resize(windows.len(), None);
            for (number, window) in windows.iter() {
                self.set(number, cache.get(window.slot), parts);
            }
        } else if !changed.is_empty() {
            self.of_window.resize(windows.len(), None);
            for &number in changed {
                let slot = windows.get(number).and_then(|w| cache.get(w.slot));
                self.set(number, slot, parts);
            }
            // A mesh that nobody draws any more is let go.
            self.draw.retain(|key, _| cache.has(key));
            self.extraction.retain(|key, _| cache.has(key));
        }
        for batch in &batches.list {
            let key = (batch.mesh.id(), batch.chunk);
            if !self.extraction.contains_key(&key)
                && let Some(groups) = parts.extraction(&batch.mesh, batch.chunk)
            {
                self.extraction.insert(key, groups);
            }
        }
    }

    fn set(&mut self, number: u32, slot: Option<&Slot>, parts: &Parts<'_>) {
        let group = slot.and_then(|slot| {
            let key = (slot.mesh.id(), slot.place.chunk);
            if let Some(group) = self.draw.get(&key) {
                return Some(group.clone());
            }
            let group = parts.draw(slot)?;
            self.draw.insert(key, group.clone());
            Some(group)
        });
        self.of_window[number as usize] = group;
    }
}

impl Parts<'_> {
    fn draw(&self, slot: &Slot) -> Option<wgpu::BindGroup> {
        let [casters, views, lights] = self.buffers.uniforms()?;
        let [caster, view, light] = UNIFORM_SIZES;
        let windows = [(casters, caster), (views, view), (lights, light)];
        let bind = |layout, buffers: &[_]| bind(self.device, self.label, layout, &windows, buffers);
        match slot.way {
            Way::Vertex => Some(bind(&self.pipelines.fed.as_ref()?.layout, &[])),
            Way::Compute | Way::Cpu => {
                let [_, _, sides] = self.buffers.chunk(slot.place.chunk)?;
                let buffers = [slot.mesh.positions(), slot.mesh.edges()?, sides];
                Some(bind(&self.pipelines.pulled.as_ref()?.layout, &buffers))
            }
        }
    }

    fn extraction(&self, mesh: &CasterMesh, chunk: usize) -> Option<[wgpu::BindGroup; 2]> {
        let bound = self.buffers.bound()?;
        let [facings, caps, sides] = self.buffers.chunk(chunk)?;
        let extraction = self.pipelines.extraction.as_ref()?;
        let params = [(bound.batches, size_of::<BatchParams>())];
        let (instances, arguments) = (bound.instances, bound.arguments);
        // A closed mesh has no list of uses, and its passes read none; any buffer will do there.
        let edges = mesh.edges()?;
        let uses = mesh.edge_uses().unwrap_or(edges);
        let (positions, triangles) = (mesh.positions(), mesh.triangles());
        let facing = [instances, arguments, positions, triangles, facings, caps];
        let edges = [instances, arguments, edges, uses, facings, sides];
        let bind = |layout, buffers: &[_]| bind(self.device, self.label, layout, &params, buffers);
        Some([
            bind(&extraction.facing.layout, &facing),
            bind(&extraction.edges.layout, &edges),
        ])
    }
}
