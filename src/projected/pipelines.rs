//! The pipelines that draw casters into tiles, clear tiles, and make mip levels.

use std::collections::HashMap;

use super::draws::{INSTANCE_SIZE, PipelineKey};
use super::texture::FORMAT;
use crate::mesh::InstanceLayout;

const CASTER: &str = include_str!("../../shaders/projected_caster.wgsl");
const TILE: &str = include_str!("../../shaders/projected_tile.wgsl");

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];

const OUR_ROWS: [wgpu::VertexAttribute; 4] = wgpu::vertex_attr_array![
    1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4
];

const HOST_COLUMNS: [wgpu::VertexAttribute; 4] = wgpu::vertex_attr_array![
    5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4
];

const HOST_ROWS: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![
    5 => Float32x4, 6 => Float32x4, 7 => Float32x4
];

/// What is there times what comes through: the order of casters does not matter.
const MULTIPLIED: wgpu::BlendComponent = wgpu::BlendComponent {
    src_factor: wgpu::BlendFactor::Dst,
    dst_factor: wgpu::BlendFactor::Zero,
    operation: wgpu::BlendOperation::Add,
};

/// The pipelines of casters, made when a draw first needs one.
#[derive(Debug)]
pub(super) struct CasterPipelines {
    label: String,
    layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    made: HashMap<PipelineKey, wgpu::RenderPipeline>,
}

impl CasterPipelines {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        Self {
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[],
                immediate_size: 0,
            }),
            shader: crate::shader::module(device, label, CASTER),
            made: HashMap::new(),
            label: label.to_owned(),
        }
    }

    /// Makes those that are missing.
    pub fn make(&mut self, device: &wgpu::Device, keys: impl Iterator<Item = PipelineKey>) {
        for key in keys {
            if !self.made.contains_key(&key) {
                let pipeline = self.pipeline(device, key);
                self.made.insert(key, pipeline);
            }
        }
    }

    pub fn get(&self, key: &PipelineKey) -> Option<&wgpu::RenderPipeline> {
        self.made.get(key)
    }

    fn pipeline(&self, device: &wgpu::Device, key: PipelineKey) -> wgpu::RenderPipeline {
        // Of a mesh at many places all are placed by one row of ours.
        let (entry_point, attributes, row_stride): (_, &[_], _) = match key.places {
            None => ("vertex", &[], INSTANCE_SIZE),
            Some((InstanceLayout::Columns4x4, _)) => ("vertex_columns", &HOST_COLUMNS, 0),
            Some((InstanceLayout::Rows3x4, _)) => ("vertex_rows", &HOST_ROWS, 0),
        };
        let buffer = |stride, step_mode, attributes| {
            Some(wgpu::VertexBufferLayout {
                array_stride: stride,
                step_mode,
                attributes,
            })
        };
        let instance = wgpu::VertexStepMode::Instance;
        let mut buffers = vec![
            buffer(key.stride, wgpu::VertexStepMode::Vertex, &POSITION),
            buffer(row_stride, instance, &OUR_ROWS),
        ];
        if let Some((_, stride)) = key.places {
            buffers.push(buffer(stride, instance, attributes));
        }
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: key.cull,
                ..Default::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: FORMAT,
                    blend: Some(wgpu::BlendState {
                        color: MULTIPLIED,
                        alpha: MULTIPLIED,
                    }),
                    write_mask: wgpu::ColorWrites::COLOR,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The pipelines that cover whole tiles.
#[derive(Debug)]
pub(super) struct TilePipelines {
    label: String,
    /// Light everywhere.
    pub clear: wgpu::RenderPipeline,
    /// Half as many texels along a side as the level that is bound.
    pub halve: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

/// A tile as `projected_tile.wgsl` gets it: its corner and side, where the layer's side is 1, and the layer.
pub(super) type TileSquare = [f32; 4];

impl TilePipelines {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let label = format!("{label} tiles");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let shader = crate::shader::module(device, &label, TILE);
        let pipeline = |entry_point, group: Option<&wgpu::BindGroupLayout>| {
            let groups: Vec<_> = group.into_iter().map(Some).collect();
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(&label),
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(&label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &shader,
                    entry_point: Some("vertex"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: size_of::<TileSquare>() as u64,
                        step_mode: wgpu::VertexStepMode::Instance,
                        attributes: &wgpu::vertex_attr_array![0 => Float32x4],
                    })],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..Default::default()
                },
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some(entry_point),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[Some(FORMAT.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        Self {
            clear: pipeline("clear", None),
            halve: pipeline("halve", Some(&layout)),
            layout,
            label,
        }
    }

    /// What [`halve`](Self::halve) reads.
    pub fn source(&self, device: &wgpu::Device, level: &wgpu::TextureView) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(level),
            }],
        })
    }
}
