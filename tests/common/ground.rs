//! A ground as a fragment shader shows it.

use host::gpu::Gpu;
use shadows::wgpu;

/// Points to a side.
pub const SIDE: u32 = 64;

/// A pipeline that shows in each point what `show` returns, the end of a function that is given `unit`, from
/// -0.5 to 0.5 along each side, and `at`, in points.
pub fn pipeline(
    gpu: &Gpu,
    module: &str,
    show: &str,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let source = format!(
        "{module}
        @vertex fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
            return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
        }}
        @fragment fn show(@builtin(position) at: vec4f) -> @location(0) vec4f {{
            let unit = at.xy / {SIDE}.0 - 0.5;
            {show}
        }}"
    );
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layouts: Vec<_> = layouts.iter().map(|layout| Some(*layout)).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("screen"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("show"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba8Unorm.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// What such a pipeline shows, four bytes a point.
pub fn picture(
    gpu: &Gpu,
    (module, show): (&str, &str),
    layouts: &[&wgpu::BindGroupLayout],
    groups: &[wgpu::BindGroup],
) -> Vec<u8> {
    let target = gpu.target([SIDE; 2], wgpu::TextureFormat::Rgba8Unorm, 1);
    gpu.checked(|| {
        let pipeline = pipeline(gpu, module, show, layouts);
        let view = target.create_view(&Default::default());
        gpu.run(|encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations::default(),
                })],
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            for (index, group) in (0..).zip(groups) {
                pass.set_bind_group(index, group, &[]);
            }
            pass.draw(0..3, 0..1);
        });
    });
    gpu.read_texture(&target, 0, wgpu::TextureAspect::All)
}
