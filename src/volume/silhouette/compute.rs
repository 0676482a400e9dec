//! Extraction on the GPU: facings and caps, then sides, in two compute passes, and a third that puts those
//! of many casters together in few draws.

use crate::volume::gpu::layout::{storage, uniform};
use crate::volume::plan::params::BatchParams;

const DISPATCH: &str = include_str!("../../../shaders/volume_dispatch.wgsl");
const BATCH: &str = include_str!("../../../shaders/volume_batch.wgsl");
/// The predicate of all ways.
pub(crate) const LIGHT_SIDE: &str = include_str!("../../../shaders/volume_light_side.wgsl");
const FACING: &str = include_str!("../../../shaders/volume_facing.wgsl");
const EDGES: &str = include_str!("../../../shaders/volume_edges.wgsl");
const MERGE: &str = include_str!("../../../shaders/volume_merge.wgsl");

/// The shader of the facing pass.
pub(crate) fn facing_source() -> String {
    [DISPATCH, BATCH, LIGHT_SIDE, FACING].join("\n")
}

/// The shader of the edge pass.
pub(crate) fn edges_source() -> String {
    [DISPATCH, BATCH, EDGES].join("\n")
}

/// The shader of the merge pass.
pub(crate) fn merge_source() -> String {
    [DISPATCH, MERGE].join("\n")
}

/// A compute pipeline and the layout of its only bind group.
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    pub layout: wgpu::BindGroupLayout,
    pub pipeline: wgpu::ComputePipeline,
}

/// The passes.
#[derive(Clone, Debug)]
pub(crate) struct Extraction {
    /// Binds batch, instances, arguments, shares, positions, triangles, facings, caps.
    pub facing: Pass,
    /// Binds batch, instances, arguments, shares, edges, uses, facings, sides.
    pub edges: Pass,
    /// Binds batch, merges, members, arguments, blocks, arguments of draws.
    pub merge: Pass,
}

impl Extraction {
    pub fn new(device: &wgpu::Device, cache: Option<&wgpu::PipelineCache>) -> Self {
        Self {
            facing: Pass::new(
                (device, cache),
                "shadows volume facing",
                facing_source(),
                "shadows_volume_facing",
                [true, false, true, true, true, false, false],
            ),
            edges: Pass::new(
                (device, cache),
                "shadows volume edges",
                edges_source(),
                "shadows_volume_edges",
                [true, false, true, true, true, true, false],
            ),
            merge: Pass::new(
                (device, cache),
                "shadows volume merge",
                merge_source(),
                "shadows_volume_merge",
                [true, true, true, false, false],
            ),
        }
    }
}

impl Pass {
    fn new<const N: usize>(
        (device, cache): (&wgpu::Device, Option<&wgpu::PipelineCache>),
        label: &str,
        source: String,
        entry_point: &str,
        read_only: [bool; N],
    ) -> Self {
        let module = crate::shader::module(device, label, source);
        let label = Some(label);
        let stage = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![uniform(0, stage, size_of::<BatchParams>())];
        entries.extend(
            (1..)
                .zip(read_only)
                .map(|(n, read)| storage(n, stage, read)),
        );
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label,
            entries: &entries,
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache,
        });
        Self { layout, pipeline }
    }
}
