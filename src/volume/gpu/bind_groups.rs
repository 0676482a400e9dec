//! Bind groups: one for each set of buffers that shaders read and write together.

use std::collections::HashMap;

use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_pipelines::Feed;
use crate::volume::gpu::layout::bind;
use crate::volume::gpu::pipelines::OwnPipelines;
use crate::volume::plan::cache::{Sources, VolumeCache};
use crate::volume::plan::draw_lists::DrawKey;
use crate::volume::plan::params::BatchParams;
use crate::volume::plan::work::{Dispatch, Work};

/// Bind groups by the buffers in them.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    generation: u64,
    draw: HashMap<DrawSources, wgpu::BindGroup>,
    facing: HashMap<Sources, wgpu::BindGroup>,
    edges: HashMap<Sources, wgpu::BindGroup>,
    merge: HashMap<Sources, wgpu::BindGroup>,
}

/// The buffers that draws read.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct DrawSources {
    feed: Feed,
    caps: bool,
    sources: Sources,
}

impl DrawSources {
    fn of(key: &DrawKey) -> Self {
        let feed = Feed::of(key.way);
        Self {
            feed,
            caps: feed == Feed::Pulled && key.style.faces.are_caps(),
            sources: key.sources.clone(),
        }
    }
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
    /// What draws read.
    pub fn of_draws(&self, key: &DrawKey) -> Option<&wgpu::BindGroup> {
        self.draw.get(&DrawSources::of(key))
    }

    /// What a dispatch of the facing pass reads and writes.
    pub fn of_facing(&self, dispatch: &Dispatch) -> Option<&wgpu::BindGroup> {
        self.facing.get(&dispatch.sources)
    }

    /// The same of the edge pass.
    pub fn of_edges(&self, dispatch: &Dispatch) -> Option<&wgpu::BindGroup> {
        self.edges.get(&dispatch.sources)
    }

    /// The same of the merge pass.
    pub fn of_merge(&self, dispatch: &Dispatch) -> Option<&wgpu::BindGroup> {
        self.merge.get(&dispatch.sources)
    }

    /// Brings the bind groups up to date, for draws of these keys.
    pub fn update<'a>(
        &mut self,
        keys: impl Iterator<Item = &'a DrawKey>,
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
            self.merge.clear();
        } else {
            // Buffers of the host that nobody draws from any more are let go.
            self.draw.retain(|draw, _| cache.has(&draw.sources));
            self.facing.retain(|sources, _| cache.has(sources));
        }
        for key in keys {
            let sources = DrawSources::of(key);
            if !self.draw.contains_key(&sources)
                && let Some(group) = parts.draw(&sources)
            {
                self.draw.insert(sources, group);
            }
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
        for Dispatch { sources, .. } in &work.merging {
            if !self.merge.contains_key(sources)
                && let Some(group) = parts.merge(sources.chunk)
            {
                self.merge.insert(sources.clone(), group);
            }
        }
    }
}

impl Parts<'_> {
    fn draw(&self, draw: &DrawSources) -> Option<wgpu::BindGroup> {
        let DrawSources {
            feed,
            caps,
            sources,
        } = draw;
        let buffers = self.buffers.uniforms()?;
        let uniforms: Vec<_> = buffers
            .into_iter()
            .zip(feed.uniforms(self.pipelines.multiview))
            .collect();
        let bind =
            |layout, storage: &[_]| bind(self.device, self.label, layout, &uniforms, storage);
        match feed {
            Feed::Records => Some(bind(&self.pipelines.fed.as_ref()?.layout, &[])),
            Feed::Pulled => {
                let [_, all_caps, sides] = self.buffers.chunk(sources.chunk)?;
                let elements = if *caps { all_caps } else { sides };
                let [positions, _, edges, _] = self.buffers.pool(sources.pool)?;
                let positions = sources.host_positions.as_ref().unwrap_or(positions);
                let layout = &self.pipelines.pulled.as_ref()?.layout;
                let [_, _, casters] = buffers;
                Some(bind(layout, &[casters, positions, edges, elements]))
            }
        }
    }

    fn merge(&self, chunk: usize) -> Option<wgpu::BindGroup> {
        let bound = self.buffers.bound()?;
        let [members, blocks, draws] = self.buffers.merged(chunk)?;
        let layout = &self.pipelines.extraction.as_ref()?.merge.layout;
        let params = [(bound.batches, size_of::<BatchParams>())];
        let buffers = [bound.merges, members?, bound.arguments, blocks?, draws?];
        Some(bind(self.device, self.label, layout, &params, &buffers))
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
