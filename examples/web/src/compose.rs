//! Both halves on the canvas, side by side.

use host::gpu::Gpu;
use host::renderer::Renderer;
use shadows::wgpu;

use crate::choice::Show;
use crate::picture::Picture;

/// Pipelines and bind groups for either of what may be shown.
pub struct Compose {
    layout: wgpu::BindGroupLayout,
    /// Of the picture and of the visibility.
    pipelines: [wgpu::RenderPipeline; 2],
    bar: wgpu::Buffer,
}

impl Compose {
    /// For targets of these formats: one that takes linear colours, one that takes bytes as they are.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat, grey: wgpu::TextureFormat) -> Self {
        let device = &gpu.device;
        let layout = layout(device);
        Self {
            pipelines: [
                pipeline(device, &layout, color, false),
                pipeline(device, &layout, grey, true),
            ],
            layout,
            bar: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("bar"),
                size: 16,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        }
    }

    /// Draws the picture; `bar` in pixels from the left.
    pub fn draw(
        &self,
        gpu: &Gpu,
        picture: &Picture,
        show: Show,
        bar: f32,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
    ) {
        gpu.queue
            .write_buffer(&self.bar, 0, bytemuck::bytes_of(&[bar, 0.0, 0.0, 0.0]));
        let group = self.group(&gpu.device, picture, show);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("compose"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..Default::default()
        });
        pass.set_pipeline(match show {
            Show::Picture => &self.pipelines[0],
            Show::Visibility => &self.pipelines[1],
        });
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn group(&self, device: &wgpu::Device, picture: &Picture, show: Show) -> wgpu::BindGroup {
        let shown = |renderer: &Renderer| match show {
            Show::Picture => renderer.shaded().create_view(&Default::default()),
            Show::Visibility => renderer.visibility().create_view(&Default::default()),
        };
        let [left, right] = picture.sides().each_ref().map(|side| shown(&side.renderer));
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("compose"),
            layout: &self.layout,
            entries: &[
                entry(0, wgpu::BindingResource::TextureView(&left)),
                entry(1, wgpu::BindingResource::TextureView(&right)),
                entry(2, self.bar.as_entire_binding()),
            ],
        })
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let picture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let bar = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("compose"),
        entries: &[entry(0, picture), entry(1, picture), entry(2, bar)],
    })
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    target: wgpu::TextureFormat,
    grey: bool,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("compose.wgsl"));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("compose"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("compose"),
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
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("grey", f64::from(u8::from(grey)))],
                ..Default::default()
            },
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
