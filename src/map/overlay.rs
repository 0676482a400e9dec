//! Pipelines that draw over a host's picture, whatever is there.

use crate::error::DebugPassError;
use crate::volume::light_pass::targets::is_drawable;

/// What one draws, and into which pass.
pub(super) struct Overlay<'a> {
    pub label: &'a str,
    /// With the entry points `vertex` and `fragment`.
    pub shader: &'static str,
    /// Group 0.
    pub layout: &'a wgpu::BindGroupLayout,
    pub buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub topology: wgpu::PrimitiveTopology,
    /// Of the fragment shader.
    pub constants: &'a [(&'a str, f64)],
    /// Of the only colour attachment.
    pub format: wgpu::TextureFormat,
    /// Of an attachment that is neither tested nor written.
    pub depth_stencil: Option<wgpu::TextureFormat>,
    pub samples: u32,
}

impl Overlay<'_> {
    /// Whether the device can have such a pass.
    fn validate(&self, device: &wgpu::Device) -> Result<(), DebugPassError> {
        if !matches!(self.samples, 1 | 4) {
            return Err(DebugPassError::SampleCount(self.samples));
        }
        let nothing_else = wgpu::TextureFormatFeatureFlags::empty();
        // The shader writes colours as floats.
        let is_float = matches!(
            self.format.sample_type(None, None),
            Some(wgpu::TextureSampleType::Float { .. })
        );
        if !(is_float && is_drawable(device, self.format, self.samples, nothing_else)) {
            return Err(DebugPassError::ColorFormat(self.format));
        }
        let is_there = |format: &wgpu::TextureFormat| {
            format.is_depth_stencil_format()
                && device.features().contains(format.required_features())
        };
        match self.depth_stencil.filter(|format| !is_there(format)) {
            Some(format) => Err(DebugPassError::DepthStencil(format)),
            None => Ok(()),
        }
    }

    pub fn pipeline(&self, device: &wgpu::Device) -> Result<wgpu::RenderPipeline, DebugPassError> {
        self.validate(device)?;
        let label = Some(self.label);
        let module = &crate::shader::module(device, self.label, self.shader);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(self.layout)],
            immediate_size: 0,
        });
        let untested = |format| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        };
        Ok(
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some("vertex"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: self.buffers,
                },
                primitive: wgpu::PrimitiveState {
                    topology: self.topology,
                    ..Default::default()
                },
                depth_stencil: self.depth_stencil.map(untested),
                multisample: wgpu::MultisampleState {
                    count: self.samples,
                    ..Default::default()
                },
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some("fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: self.constants,
                        ..Default::default()
                    },
                    targets: &[Some(self.format.into())],
                }),
                multiview_mask: None,
                cache: None,
            }),
        )
    }
}
