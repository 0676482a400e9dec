//! Casters culled by a compute shader.

use std::time::Duration;

use shadows::glam::{DVec3, DVec4};
use shadows::wgpu;
use wgpu::util::DeviceExt as _;

use super::RANGE;
use host::gpu::Gpu;

/// A list for each light, and how long it is: the instance count of an indirect draw.
const SHADER: &str = "
@group(0) @binding(0) var<storage, read> spheres: array<vec4f>;
@group(0) @binding(1) var<storage, read> lights: array<vec4f, 16>;
@group(0) @binding(2) var<storage, read_write> counts: array<atomic<u32>, 16>;
@group(0) @binding(3) var<storage, read_write> lists: array<u32>;

@compute @workgroup_size(64)
fn cull(@builtin(global_invocation_id) id: vec3u) {
    let count = arrayLength(&spheres);
    if id.x >= count {
        return;
    }
    let sphere = spheres[id.x];
    for (var light = 0u; light < 16u; light++) {
        let toward = sphere.xyz - lights[light].xyz;
        let reach = lights[light].w + sphere.w;
        if dot(toward, toward) <= reach * reach {
            lists[light * count + atomicAdd(&counts[light], 1u)] = id.x;
        }
    }
}
";

pub struct Culling {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    spheres: wgpu::Buffer,
    lights: wgpu::Buffer,
    counts: wgpu::Buffer,
    groups: u32,
}

impl Culling {
    pub fn new(gpu: &Gpu, casters: usize) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("culling"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("culling"),
            layout: None,
            module: &module,
            entry_point: Some("cull"),
            compilation_options: Default::default(),
            cache: None,
        });
        let buffer = |bytes: usize| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("culling"),
                contents: &vec![0; bytes],
                usage: wgpu::BufferUsages::STORAGE
                    | wgpu::BufferUsages::COPY_DST
                    | wgpu::BufferUsages::COPY_SRC,
            })
        };
        let [spheres, lights, counts, lists] =
            [16 * casters, 16 * 16, 4 * 16, 4 * 16 * casters].map(buffer);
        let buffers = [&spheres, &lights, &counts, &lists];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        Self {
            group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("culling"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            }),
            pipeline,
            spheres,
            lights,
            counts,
            groups: casters.div_ceil(64) as u32,
        }
    }

    /// From submission to done, less what a submission of next to nothing takes; what is uploaded
    /// does not count.
    pub fn time(&self, gpu: &Gpu, spheres: &[DVec4], lights: &[DVec3]) -> Duration {
        let spheres: Vec<_> = spheres.iter().map(|s| s.as_vec4()).collect();
        let lights: Vec<_> = lights.iter().map(|l| l.extend(RANGE).as_vec4()).collect();
        gpu.queue
            .write_buffer(&self.spheres, 0, bytemuck::cast_slice(&spheres));
        gpu.queue
            .write_buffer(&self.lights, 0, bytemuck::cast_slice(&lights));
        gpu.run(|_| {});
        let nothing = gpu.run(|encoder| encoder.clear_buffer(&self.counts, 0, None));
        let all = gpu.run(|encoder| {
            encoder.clear_buffer(&self.counts, 0, None);
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.dispatch_workgroups(self.groups, 1, 1);
        });
        all.saturating_sub(nothing)
    }

    /// Casters in all lists of the last time.
    pub fn found(&self, gpu: &Gpu) -> u32 {
        let counts: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(&self.counts));
        counts.iter().sum()
    }
}
