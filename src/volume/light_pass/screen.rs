//! Pipelines that cover the screen where the stencil count says so.

use crate::volume::multiview::Multiview;

/// A vertex shader `screen` that covers the screen, and a fragment shader `one`.
pub(crate) const SCREEN: &str = include_str!("../../../shaders/volume_screen.wgsl");

/// What such a pipeline needs to know.
pub(crate) struct ScreenPipeline<'a> {
    pub label: &'a str,
    pub source: String,
    pub fragment: &'a str,
    pub layout: &'a [Option<&'a wgpu::BindGroupLayout>],
    pub target: Option<wgpu::ColorTargetState>,
    /// `None` if the pass has no such buffer.
    pub depth_stencil_format: Option<wgpu::TextureFormat>,
    pub sample_count: u32,
    pub multiview: Multiview,
    pub on: On,
}

/// Where such a pipeline draws.
#[derive(Clone, Copy, Debug)]
pub(crate) enum On {
    Everything,
    /// What the stencil has counted in no volume.
    Lit,
    /// Wherever the fragment shader does not discard: the stencil becomes the reference there.
    Marked,
}

impl ScreenPipeline<'_> {
    pub fn make(self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let label = Some(self.label);
        let module = crate::shader::module(device, self.label, self.source);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: self.layout,
            immediate_size: 0,
        });
        let options = wgpu::PipelineCompilationOptions::default;
        let targets: Vec<_> = self.target.into_iter().map(Some).collect();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("screen"),
                compilation_options: options(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: self
                .depth_stencil_format
                .map(|format| wgpu::DepthStencilState {
                    format,
                    depth_write_enabled: Some(false),
                    depth_compare: Some(wgpu::CompareFunction::Always),
                    stencil: stencil(self.on),
                    bias: wgpu::DepthBiasState::default(),
                }),
            multisample: wgpu::MultisampleState {
                count: self.sample_count,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.fragment),
                compilation_options: options(),
                targets: &targets,
            }),
            multiview_mask: self.multiview.0,
            cache: None,
        })
    }
}

/// A test without a guard: nothing but one triangle is drawn, and except where it marks, the stencil
/// may be read-only.
fn stencil(on: On) -> wgpu::StencilState {
    let (compare, pass_op, write_mask) = match on {
        On::Everything => (
            wgpu::CompareFunction::Always,
            wgpu::StencilOperation::Keep,
            0,
        ),
        On::Lit => (
            wgpu::CompareFunction::Equal,
            wgpu::StencilOperation::Keep,
            0,
        ),
        On::Marked => (
            wgpu::CompareFunction::Always,
            wgpu::StencilOperation::Replace,
            0xff,
        ),
    };
    let face = wgpu::StencilFaceState {
        compare,
        pass_op,
        ..wgpu::StencilFaceState::IGNORE
    };
    wgpu::StencilState {
        front: face,
        back: face,
        read_mask: 0xff,
        write_mask,
    }
}
