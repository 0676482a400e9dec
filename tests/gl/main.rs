//! Found 16: what wgpu's GL back end reads wrong without a word, right or refused.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/cubes.rs"]
mod cubes;
mod depth;
#[path = "../common/ground.rs"]
mod ground;
mod kinds;
mod old_gl;
#[path = "../common/receivers.rs"]
mod receivers;
mod samples;

use host::gpu::Gpu;
use shadows::wgpu;

/// A device of the GL back end, or `None` (said on stderr) where there is none.
fn gl() -> Option<Gpu> {
    let Ok(gpu) = Gpu::new(Some("(gl,")) else {
        eprintln!("skipped: no GL adapter");
        return None;
    };
    assert_eq!(gpu.info.backend, wgpu::Backend::Gl);
    Some(gpu)
}

/// What a compute shader, whose function `ask(i)` gives a number, says for the numbers below `count`.
/// Group 0 is the result, group 1 the shader's own.
fn ask(
    gpu: &Gpu,
    source: &str,
    (own_layout, own): (&wgpu::BindGroupLayout, &wgpu::BindGroup),
    count: u32,
) -> Vec<f32> {
    let source = format!(
        "{source}
        @group(0) @binding(0) var<storage, read_write> answers: array<f32>;
        @compute @workgroup_size(1)
        fn main(@builtin(global_invocation_id) id: vec3u) {{
            answers[id.x] = ask(id.x);
        }}"
    );
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layouts = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout), Some(own_layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layouts),
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let answers = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4 * u64::from(count),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: answers.as_entire_binding(),
        }],
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_bind_group(1, own, &[]);
        pass.dispatch_workgroups(count, 1, 1);
    });
    bytemuck::pod_collect_to_vec(&gpu.read_buffer(&answers))
}
