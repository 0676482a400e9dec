//! Tiles that are cleared, or begun with what is static on them, in a layer that they share with others.

use crate::map::encoding::DepthEncoding;

const SHADER: &str = include_str!("../../../shaders/tile_fill.wgsl");

/// The pipelines that fill a viewport.
#[derive(Debug)]
pub(crate) struct TileFill {
    label: String,
    clear: wgpu::RenderPipeline,
    copy: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl TileFill {
    pub fn new(device: &wgpu::Device, label: &str, format: wgpu::TextureFormat) -> Self {
        let label = format!("{label} fill");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    // Not as depth, which GL does not load texel by texel.
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let shader = crate::shader::module(device, &label, SHADER);
        let pipeline = |group: Option<&wgpu::BindGroupLayout>| {
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
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Always),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: group.map(|_| wgpu::FragmentState {
                    module: &shader,
                    entry_point: Some("fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &[],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        Self {
            clear: pipeline(None),
            copy: pipeline(Some(&layout)),
            layout,
            label,
        }
    }

    /// What [`copy`](Self::copy) copies from.
    pub fn source(&self, device: &wgpu::Device, view: &wgpu::TextureView) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(view),
            }],
        })
    }

    /// Fills the viewport with [`DepthEncoding::MajorAxis`]'s clear depth.
    pub fn clear(&self, pass: &mut wgpu::RenderPass<'_>) {
        debug_assert_eq!(DepthEncoding::MajorAxis.clear_depth(), 0.0);
        pass.set_pipeline(&self.clear);
        pass.draw(0..3, 0..1);
    }

    /// Fills the viewport with what another texture has there.
    pub fn copy(&self, pass: &mut wgpu::RenderPass<'_>, source: &wgpu::BindGroup) {
        pass.set_pipeline(&self.copy);
        pass.set_bind_group(0, source, &[]);
        pass.draw(0..3, 0..1);
    }
}
