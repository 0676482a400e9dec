//! Pipelines that cover the screen where the stencil count says so.

/// A vertex shader `screen` that covers the screen, and a fragment shader `one`.
pub(super) const SCREEN: &str = include_str!("../../shaders/volume_screen.wgsl");

/// What such a pipeline needs to know.
pub(super) struct ScreenPipeline<'a> {
    pub label: &'a str,
    pub source: String,
    pub fragment: &'a str,
    pub layout: &'a [Option<&'a wgpu::BindGroupLayout>],
    pub target: wgpu::ColorTargetState,
    pub depth_stencil_format: wgpu::TextureFormat,
    pub sample_count: u32,
    /// Whether only what is in no volume is drawn, or everything.
    pub lit_only: bool,
}

impl ScreenPipeline<'_> {
    pub fn make(self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let label = Some(self.label);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(self.source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: self.layout,
            immediate_size: 0,
        });
        let options = wgpu::PipelineCompilationOptions::default;
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
            depth_stencil: Some(wgpu::DepthStencilState {
                format: self.depth_stencil_format,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: stencil(self.lit_only),
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
                targets: &[Some(self.target)],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A test without a guard: nothing but one triangle is drawn, and the stencil may be read-only.
fn stencil(lit_only: bool) -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: match lit_only {
            true => wgpu::CompareFunction::Equal,
            false => wgpu::CompareFunction::Always,
        },
        ..wgpu::StencilFaceState::IGNORE
    };
    wgpu::StencilState {
        front: face,
        back: face,
        read_mask: 0xff,
        write_mask: 0,
    }
}
