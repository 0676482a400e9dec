//! Bind groups: one for each set of buffers that shaders read and write together.

use std::collections::HashMap;

use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_pipelines::UNIFORM_SIZES;
use crate::volume::gpu::layout::bind;
use crate::volume::gpu::pipelines::OwnPipelines;
use crate::volume::plan::cache::{Slot, Sources, VolumeCache};
use crate::volume::plan::params::BatchParams;
use crate::volume::plan::windows::Windows;
use crate::volume::plan::work::{Dispatch, Work};
use crate::volume::silhouette::Way;

/// Bind groups by the buffers in them.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    generation: u64,
    draw: HashMap<Sources, wgpu::BindGroup>,
    facing: HashMap<Sources, wgpu::BindGroup>,
    edges: HashMap<Sources, wgpu::BindGroup>,
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

    /// What a dispatch of the facing pass reads and writes.
    pub fn of_facing(&self, dispatch: &Dispatch) -> Option<&wgpu::BindGroup> {
        self.facing.get(&dispatch.sources)
    }

    /// The same of the edge pass.
    pub fn of_edges(&self, dispatch: &Dispatch) -> Option<&wgpu::BindGroup> {
        self.edges.get(&dispatch.sources)
    }

    /// Brings the bind groups up to date: those of windows that changed, and all if buffers were made
    /// anew.
    pub fn update(
        &mut self,
        (windows, changed): (&Windows, &[u32]),
        work: &Work,
        cache: &VolumeCache,
        parts: &Parts<'_>,
    ) {
        let generation = parts.buffers.generation();
        if self.generation != generation {
            self.generation = generation;
            self.draw.clear();
            self.facing.clear();
            self.edges.clear();
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
            // Buffers of the host that nobody draws from any more are let go.
            self.draw.retain(|sources, _| cache.has(sources));
            self.facing.retain(|sources, _| cache.has(sources));
        }
        for Dispatch { sources, .. } in &work.facing {
            if !self.facing.contains_key(sources)
                && let Some(group) = parts.facing(sources)
            {
                self.facing.insert(sources.clone(), group);
            }
        }
        for Dispatch { sources, .. } in &work.edges {
            if !self.edges.contains_key(sources)
                && let Some(group) = parts.edges(sources)
            {
                self.edges.insert(sources.clone(), group);
            }
        }
    }

    fn set(&mut self, number: u32, slot: Option<&Slot>, parts: &Parts<'_>) {
        let group = slot.and_then(|slot| {
            let sources = slot.sources();
            if let Some(group) = self.draw.get(&sources) {
                return Some(group.clone());
            }
            let group = parts.draw(slot.way, &sources)?;
            self.draw.insert(sources, group.clone());
            Some(group)
        });
        self.of_window[number as usize] = group;
    }
}

impl Parts<'_> {
    fn draw(&self, way: Way, sources: &Sources) -> Option<wgpu::BindGroup> {
        let [casters, views, lights] = self.buffers.uniforms()?;
        let [caster, view, light] = UNIFORM_SIZES;
        let windows = [(casters, caster), (views, view), (lights, light)];
        let bind = |layout, buffers: &[_]| bind(self.device, self.label, layout, &windows, buffers);
        match way {
            Way::Vertex => Some(bind(&self.pipelines.fed.as_ref()?.layout, &[])),
            Way::Compute | Way::Cpu => {
                let [_, _, sides] = self.buffers.chunk(sources.chunk)?;
                let [positions, _, edges, _] = self.buffers.pool(sources.pool)?;
                let positions = sources.host_positions.as_ref().unwrap_or(positions);
                let layout = &self.pipelines.pulled.as_ref()?.layout;
                Some(bind(layout, &[positions, edges, sides]))
            }
        }
    }

    fn facing(&self, sources: &Sources) -> Option<wgpu::BindGroup> {
        let [facings, caps, _] = self.buffers.chunk(sources.chunk)?;
        let [positions, triangles, ..] = self.buffers.pool(sources.pool)?;
        let positions = sources.host_positions.as_ref().unwrap_or(positions);
        let layout = &self.pipelines.extraction.as_ref()?.facing.layout;
        self.extraction(layout, [positions, triangles, facings, caps])
    }

    fn edges(&self, sources: &Sources) -> Option<wgpu::BindGroup> {
        let [facings, _, sides] = self.buffers.chunk(sources.chunk)?;
        let [_, _, edges, uses] = self.buffers.pool(sources.pool)?;
        let layout = &self.pipelines.extraction.as_ref()?.edges.layout;
        self.extraction(layout, [edges, uses, facings, sides])
    }

    fn extraction(
        &self,
        layout: &wgpu::BindGroupLayout,
        [first, second, third, fourth]: [&wgpu::Buffer; 4],
    ) -> Option<wgpu::BindGroup> {
        let bound = self.buffers.bound()?;
        let params = [(bound.batches, size_of::<BatchParams>())];
        let (instances, arguments, shares) = (bound.instances, bound.arguments, bound.shares);
        let buffers = [instances, arguments, shares, first, second, third, fourth];
        Some(bind(self.device, self.label, layout, &params, &buffers))
    }
}
