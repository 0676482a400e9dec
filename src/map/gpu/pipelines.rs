//! The pipelines that draw casters into tiles.

use std::collections::HashMap;

use super::instances::INSTANCE_SIZE;
use crate::gl;
use crate::map::encoding::DepthEncoding;
use crate::mesh::InstanceLayout;

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];

const OUR_ROWS: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![
    1 => Float32x4, 2 => Float32x4, 3 => Float32x4
];

const HOST_COLUMNS: [wgpu::VertexAttribute; 4] = wgpu::vertex_attr_array![
    4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4
];

const HOST_ROWS: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![
    4 => Float32x4, 5 => Float32x4, 6 => Float32x4
];

/// All that two draws must share to use the same pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct PipelineKey {
    /// Bytes between positions.
    pub stride: u64,
    pub cull: Option<wgpu::Face>,
    /// The host's transforms, and bytes between them.
    pub places: Option<(InstanceLayout, u64)>,
}

/// What all pipelines of one map share.
#[derive(Debug)]
pub(crate) struct PipelineKind {
    pub format: wgpu::TextureFormat,
    pub encoding: DepthEncoding,
    pub slope_scale: f32,
    /// Whether casters before the near plane are pulled onto it.
    pub unclipped_depth: bool,
}

/// The pipelines of a map, made when a draw first needs one.
#[derive(Debug)]
pub(crate) struct Pipelines {
    label: String,
    kind: PipelineKind,
    layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    /// Whether fragments write the depth, in every encoding.
    depth_written: bool,
    made: HashMap<PipelineKey, wgpu::RenderPipeline>,
}

impl Pipelines {
    /// `uniforms`: the layout of the only bind group.
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        uniforms: &wgpu::BindGroupLayout,
        kind: PipelineKind,
    ) -> Self {
        Self {
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(uniforms)],
                immediate_size: 0,
            }),
            shader: caster_shader(device, label),
            depth_written: writes_depth(device),
            made: HashMap::new(),
            label: label.to_owned(),
            kind,
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
        let kind = &self.kind;
        let fragment = match (kind.encoding, self.depth_written) {
            (DepthEncoding::MajorAxis, false) => None,
            (DepthEncoding::MajorAxis, true) => Some("fragment_depth"),
            (DepthEncoding::LinearDistance, _) => Some("fragment_distance"),
        };
        let written = [
            ("slope_scale", f64::from(kind.slope_scale)),
            ("pulled", f64::from(u8::from(kind.unclipped_depth))),
        ];
        // Of a mesh at many places all are placed by one row of ours.
        let (entry_point, attributes, row_stride): (_, &[_], _) = match key.places {
            None => ("vertex", &[], INSTANCE_SIZE),
            Some((InstanceLayout::Columns4x4, _)) => ("vertex_columns", &HOST_COLUMNS, 0),
            Some((InstanceLayout::Rows3x4, _)) => ("vertex_rows", &HOST_ROWS, 0),
        };
        let places = key.places.map(|(_, stride)| wgpu::VertexBufferLayout {
            array_stride: stride,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes,
        });
        let mut buffers = vec![
            Some(wgpu::VertexBufferLayout {
                array_stride: key.stride,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &POSITION,
            }),
            Some(wgpu::VertexBufferLayout {
                array_stride: row_stride,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &OUR_ROWS,
            }),
        ];
        if places.is_some() {
            buffers.push(places);
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
                unclipped_depth: kind.unclipped_depth && !self.depth_written,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: kind.format,
                depth_write_enabled: Some(true),
                depth_compare: Some(kind.encoding.nearer()),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState {
                    // Away from the light is down in reverse-Z.
                    slope_scale: -kind.slope_scale,
                    ..Default::default()
                },
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: fragment.map(|entry_point| wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: if self.depth_written { &written } else { &[] },
                    ..Default::default()
                },
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Whether casters before a near plane can be pulled onto it. There they still are before every
/// receiver. What is behind the light stays clipped by the sides of the frustum, which meet in it; so
/// on a cube face, too, nothing is drawn that does not lie in the face's own pyramid.
pub(crate) fn can_pull_casters(device: &wgpu::Device) -> bool {
    let features = device.features();
    features.contains(wgpu::Features::DEPTH_CLIP_CONTROL) || writes_depth(device)
}

/// Whether fragments write the depth, because vertices cannot: see `cube_caster_gl.wgsl`. What fragments
/// write is never clipped.
fn writes_depth(device: &wgpu::Device) -> bool {
    gl::is_gl(device)
}

/// Draws casters on one face.
fn caster_shader(device: &wgpu::Device, label: &str) -> wgpu::ShaderModule {
    let source = match writes_depth(device) {
        false => crate::wgsl::CUBE_CASTER,
        true => crate::wgsl::CUBE_CASTER_GL,
    };
    crate::shader::module(device, label, source)
}
