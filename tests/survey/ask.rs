//! What functions of a module answer, asked by a compute shader: no camera and no rasteriser between the question and
//! the answer.

use host::gpu::Gpu;
use shadows::wgpu;
use wgpu::util::DeviceExt as _;

/// Runs the entry point `ask`, 64 invocations a workgroup, over questions (`var<storage, read>`, binding 0 of group
/// 0) and gives its answers (`var<storage, read_write>`, binding 1), one for each. Group 1 is the module's own.
pub fn answers_by<Q: bytemuck::NoUninit, A: bytemuck::Pod>(
    gpu: &Gpu,
    wgsl: String,
    (layout, group): (&wgpu::BindGroupLayout, &wgpu::BindGroup),
    questions: &[Q],
) -> Vec<A> {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(questions),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let output = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: (size_of::<A>() * questions.len()) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let entry = |binding, read_only| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let own = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[entry(0, true), entry(1, false)],
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&own), Some(layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("ask"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffers = [&input, &output];
    let entries = [0, 1].map(|binding: usize| wgpu::BindGroupEntry {
        binding: binding as u32,
        resource: buffers[binding].as_entire_binding(),
    });
    let asked = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &own,
        entries: &entries,
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &asked, &[]);
        pass.set_bind_group(1, group, &[]);
        pass.dispatch_workgroups((questions.len() as u32).div_ceil(64), 1, 1);
    });
    bytemuck::pod_collect_to_vec(&gpu.read_buffer(&output))
}
