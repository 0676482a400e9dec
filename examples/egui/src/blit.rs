//! Copies a picture into egui's pass.

use shadows::wgpu;

use host::renderer::Renderer;

/// Pipelines for the shaded picture and for the visibility, and what they read.
pub struct Blit {
    layout: wgpu::BindGroupLayout,
    shaded: wgpu::RenderPipeline,
    visibility: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

impl Blit {
    /// For a pass of this format.
    pub fn new(device: &wgpu::Device, window: wgpu::TextureFormat, renderer: &Renderer) -> Self {
        let layout = layout(device);
        Self {
            shaded: pipeline(device, window, &layout, "shaded"),
            visibility: pipeline(device, window, &layout, "visibility"),
            group: group(device, &layout, renderer),
            layout,
        }
    }

    /// To be called when the renderer has new targets.
    pub fn bind(&mut self, device: &wgpu::Device, renderer: &Renderer) {
        self.group = group(device, &self.layout, renderer);
    }

    /// Draws into the pass's viewport.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, visibility: bool) {
        pass.set_pipeline(if visibility {
            &self.visibility
        } else {
            &self.shaded
        });
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("blit"),
        entries: &[entry(0), entry(1)],
    })
}

fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    renderer: &Renderer,
) -> wgpu::BindGroup {
    let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
    let (shaded, visibility) = (view(renderer.shaded()), view(renderer.visibility()));
    let entry = |binding, view| wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("blit"),
        layout,
        entries: &[entry(0, &shaded), entry(1, &visibility)],
    })
}

fn pipeline(
    device: &wgpu::Device,
    window: wgpu::TextureFormat,
    layout: &wgpu::BindGroupLayout,
    fragment: &str,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("blit.wgsl"));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("blit"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    // egui asks for a window whose values are sRGB already, but not every surface has one.
    let encodes = f64::from(u8::from(!window.is_srgb()));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("blit"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("encodes", encodes)],
                ..Default::default()
            },
            targets: &[Some(window.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
