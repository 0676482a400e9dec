//! The pipelines that count a volume's faces in the stencil buffer.

use super::ShadowVolumeDescriptor;
use super::layout::{storage, uniform};
use super::params::CasterParams;
use super::plan::Faces;
use crate::wgsl::POSITION;

const DRAW: &str = include_str!("../../shaders/volume_draw.wgsl");

/// The shader of all faces.
pub(super) fn source() -> String {
    [POSITION, DRAW].join("\n")
}

/// z-fail: a back face behind the visible point counts +1, a front face -1, modulo 256 because the
/// faces come in any order.
fn z_fail() -> wgpu::StencilState {
    let count = |depth_fail_op| wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op,
        pass_op: wgpu::StencilOperation::Keep,
    };
    wgpu::StencilState {
        front: count(wgpu::StencilOperation::DecrementWrap),
        back: count(wgpu::StencilOperation::IncrementWrap),
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

/// What the light pass demands of the count, and the guard it leaves.
pub(super) fn light_pass() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Equal,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: wgpu::StencilOperation::IncrementClamp,
    };
    wgpu::StencilState {
        front: face,
        back: face,
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

/// One pipeline for each kind of faces and each way that "front" may turn on screen.
#[derive(Debug)]
pub(super) struct DrawPipelines {
    /// Binds caster, positions, edges, sides.
    pub layout: wgpu::BindGroupLayout,
    pipelines: [[wgpu::RenderPipeline; 2]; 3],
}

impl DrawPipelines {
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowVolumeDescriptor<'_>,
        label: &str,
    ) -> Self {
        let stage = wgpu::ShaderStages::VERTEX;
        let mut entries = vec![uniform(stage, size_of::<CasterParams>())];
        entries.extend((1..=3).map(|binding| storage(binding, stage, true)));
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        });
        let factory = Factory {
            device,
            descriptor,
            label,
            module: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(source().into()),
            }),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            }),
        };
        let pipelines = [Faces::LightCap, Faces::DarkCap, Faces::Sides].map(|faces| {
            [wgpu::FrontFace::Ccw, wgpu::FrontFace::Cw].map(|f| factory.make(faces, f))
        });
        Self { layout, pipelines }
    }

    pub fn get(&self, faces: Faces, clockwise: bool) -> &wgpu::RenderPipeline {
        let [light_cap, dark_cap, sides] = &self.pipelines;
        let [ccw, cw] = match faces {
            Faces::LightCap => light_cap,
            Faces::DarkCap => dark_cap,
            Faces::Sides => sides,
        };
        if clockwise { cw } else { ccw }
    }
}

struct Factory<'a> {
    device: &'a wgpu::Device,
    descriptor: &'a ShadowVolumeDescriptor<'a>,
    label: &'a str,
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
}

impl Factory<'_> {
    fn make(&self, faces: Faces, front_face: wgpu::FrontFace) -> wgpu::RenderPipeline {
        let label = format!("{} {faces:?} {front_face:?}", self.label);
        let entry_point = match faces {
            Faces::LightCap => "shadows_volume_light_cap",
            Faces::DarkCap => "shadows_volume_dark_cap",
            Faces::Sides => "shadows_volume_side",
        };
        let targets = self.targets();
        // A pass without colour needs no fragment stage, and is faster without.
        let fragment = (!targets.is_empty()).then(|| wgpu::FragmentState {
            module: &self.module,
            entry_point: Some("shadows_volume_nothing"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        });
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(&label),
                layout: Some(&self.layout),
                vertex: wgpu::VertexState {
                    module: &self.module,
                    entry_point: Some(entry_point),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    front_face,
                    cull_mode: None,
                    // Faces beyond a finite far plane must count; clamped, they do.
                    unclipped_depth: self.descriptor.depth.clips_far(),
                    ..Default::default()
                },
                depth_stencil: Some(self.depth_stencil(faces)),
                multisample: wgpu::MultisampleState {
                    count: self.descriptor.sample_count,
                    ..Default::default()
                },
                fragment,
                multiview_mask: None,
                cache: None,
            })
    }

    fn targets(&self) -> Vec<Option<wgpu::ColorTargetState>> {
        let target = |format| wgpu::ColorTargetState {
            format,
            blend: None,
            write_mask: wgpu::ColorWrites::empty(),
        };
        let formats = self.descriptor.color_formats.iter();
        formats.map(|format| format.map(target)).collect()
    }

    fn depth_stencil(&self, faces: Faces) -> wgpu::DepthStencilState {
        let depth = self.descriptor.depth;
        let bias = match faces {
            Faces::LightCap => i32::try_from(self.descriptor.cap_bias_ulps).unwrap_or(i32::MAX),
            Faces::DarkCap | Faces::Sides => 0,
        };
        wgpu::DepthStencilState {
            format: self.descriptor.depth_stencil_format,
            depth_write_enabled: Some(false),
            // A cap at the visible depth itself is behind it: strictly nearer passes.
            depth_compare: Some(depth.nearer()),
            stencil: z_fail(),
            bias: wgpu::DepthBiasState {
                constant: bias * depth.away(),
                ..Default::default()
            },
        }
    }
}
