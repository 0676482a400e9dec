//! The pipelines that count a volume's faces in the stencil buffer.

use super::ShadowVolumeDescriptor;
use super::layout::{storage, uniform};
use super::method::Count;
use super::params::CasterParams;
use super::plan::Faces;
use crate::wgsl::POSITION;

const DRAW: &str = include_str!("../../shaders/volume_draw.wgsl");

/// The shader of all faces.
pub(super) fn source() -> String {
    [POSITION, DRAW].join("\n")
}

/// z-fail: a back face behind the visible point counts +1, a front face -1; z-pass: a front face
/// before it +1, a back face -1. Modulo 256, because the faces come in any order.
fn counting(count: Count) -> wgpu::StencilState {
    use wgpu::StencilOperation::{DecrementWrap, IncrementWrap, Keep};
    let face = |pass_op, depth_fail_op| wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: Keep,
        depth_fail_op,
        pass_op,
    };
    let (front, back) = match count {
        Count::Fail => (face(Keep, DecrementWrap), face(Keep, IncrementWrap)),
        Count::Pass => (face(IncrementWrap, Keep), face(DecrementWrap, Keep)),
    };
    wgpu::StencilState {
        front,
        back,
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

/// One pipeline for each kind of faces, way to count and way that "front" may turn on screen.
#[derive(Debug)]
pub(super) struct DrawPipelines {
    /// Binds caster, positions, edges, sides.
    pub layout: wgpu::BindGroupLayout,
    pipelines: Vec<(Style, wgpu::RenderPipeline)>,
}

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Style {
    pub count: Count,
    pub faces: Faces,
    /// Whether faces that are clockwise on screen are the volume's front.
    pub clockwise: bool,
}

/// z-pass needs no caps, except the fan where rays may start beyond a finite volume.
const KINDS: [(Count, Faces); 6] = [
    (Count::Fail, Faces::LightCap),
    (Count::Fail, Faces::DarkCap),
    (Count::Fail, Faces::Sides),
    (Count::Fail, Faces::Fan),
    (Count::Pass, Faces::Sides),
    (Count::Pass, Faces::Fan),
];

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
        let styles = KINDS.into_iter().flat_map(|(count, faces)| {
            [false, true].map(|clockwise| Style {
                count,
                faces,
                clockwise,
            })
        });
        let pipelines = styles.map(|style| (style, factory.make(style))).collect();
        Self { layout, pipelines }
    }

    /// The pipeline, for every style that a plan uses.
    pub fn get(&self, style: Style) -> Option<&wgpu::RenderPipeline> {
        let found = self.pipelines.iter().find(|(known, _)| *known == style);
        found.map(|(_, pipeline)| pipeline)
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
    fn make(&self, style: Style) -> wgpu::RenderPipeline {
        let label = format!("{} {style:?}", self.label);
        let entry_point = match style.faces {
            Faces::LightCap => "shadows_volume_light_cap",
            Faces::DarkCap => "shadows_volume_dark_cap",
            Faces::Sides => "shadows_volume_side",
            Faces::Fan => "shadows_volume_fan",
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
                    front_face: match style.clockwise {
                        false => wgpu::FrontFace::Ccw,
                        true => wgpu::FrontFace::Cw,
                    },
                    cull_mode: None,
                    // Faces beyond a finite far plane must count; clamped, they do.
                    unclipped_depth: self.descriptor.depth.clips_far(),
                    ..Default::default()
                },
                depth_stencil: Some(self.depth_stencil(style)),
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

    fn depth_stencil(&self, style: Style) -> wgpu::DepthStencilState {
        let depth = self.descriptor.depth;
        let bias = match style.faces {
            Faces::LightCap => i32::try_from(self.descriptor.cap_bias_ulps).unwrap_or(i32::MAX),
            Faces::DarkCap | Faces::Sides | Faces::Fan => 0,
        };
        wgpu::DepthStencilState {
            format: self.descriptor.depth_stencil_format,
            depth_write_enabled: Some(false),
            // A cap at the visible depth itself is behind it: strictly nearer passes.
            depth_compare: Some(depth.nearer()),
            stencil: counting(style.count),
            bias: wgpu::DepthBiasState {
                constant: bias * depth.away(),
                ..Default::default()
            },
        }
    }
}
