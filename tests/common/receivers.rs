//! Visibility of given points, read by a compute shader through the crate's own WGSL: no camera,
//! no rasteriser between the point that is asked for and the answer.
#![allow(dead_code)] // each test uses its own part

use shadows::glam::Vec3;
use shadows::{AnyMap, Kernel, MapKind, PcfDescriptor, PcfSampler, wgpu};
use wgpu::util::DeviceExt as _;

use host::gpu::Gpu;

const SHADER: &str = "
@group(0) @binding(0) var<storage, read> points: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> visibility: array<f32>;
@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&visibility) {
        let pixel = vec2f(points[2 * id.x].w, points[2 * id.x + 1].w);
        visibility[id.x] =
            shadows_visibility_flat(points[2 * id.x].xyz, points[2 * id.x + 1].xyz PIXEL);
    }
}
";

/// Visibility of points with geometric normals, each as if at a pixel of its own.
pub fn visibility<'a>(
    gpu: &Gpu,
    map: impl Into<AnyMap<'a>>,
    kernel: Kernel,
    points: &[(Vec3, Vec3)],
) -> Vec<f32> {
    let map = map.into();
    let descriptor = PcfDescriptor {
        kernel,
        map: map.kind(),
        ..Default::default()
    };
    ask(gpu, map, &descriptor, 0, points)
}

/// The pixel that point `i` is taken to be at.
pub fn pixel(i: usize) -> [f32; 2] {
    [(i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5]
}

/// Visibility from a map, or from one light of an atlas, by any sampler.
pub fn ask<'a>(
    gpu: &Gpu,
    map: impl Into<AnyMap<'a>>,
    descriptor: &PcfDescriptor<'_>,
    light: usize,
    points: &[(Vec3, Vec3)],
) -> Vec<f32> {
    ask_changed(gpu, map.into(), descriptor, light, points, |module| module)
}

/// The same with the sampler's module changed, for tests of what must fail.
pub fn ask_changed(
    gpu: &Gpu,
    map: AnyMap<'_>,
    descriptor: &PcfDescriptor<'_>,
    light: usize,
    points: &[(Vec3, Vec3)],
    change: impl FnOnce(String) -> String,
) -> Vec<f32> {
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, descriptor).unwrap();
    let group = sampler.bind_group(&gpu.device, map).unwrap();
    ask_group(gpu, (&sampler, &group), descriptor, light, points, change)
}

/// The same through a bind group that is there already.
pub fn ask_group(
    gpu: &Gpu,
    (sampler, map_group): (&PcfSampler, &wgpu::BindGroup),
    descriptor: &PcfDescriptor<'_>,
    light: usize,
    points: &[(Vec3, Vec3)],
    change: impl FnOnce(String) -> String,
) -> Vec<f32> {
    Questions::new(gpu, sampler, descriptor, light, points, change).ask(gpu, map_group)
}

/// Points that are asked for again and again.
pub struct Questions {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    output: wgpu::Buffer,
    count: u32,
}

impl Questions {
    pub fn new(
        gpu: &Gpu,
        sampler: &PcfSampler,
        descriptor: &PcfDescriptor<'_>,
        light: usize,
        points: &[(Vec3, Vec3)],
        change: impl FnOnce(String) -> String,
    ) -> Self {
        let device = &gpu.device;
        let call = match descriptor.map {
            MapKind::Atlas(_) => format!("shadows_visibility_flat({light}u, "),
            _ => "shadows_visibility_flat(".to_owned(),
        };
        let pixel_argument = if sampler.takes_pixel() { ", pixel" } else { "" };
        let shader = SHADER
            .replace("shadows_visibility_flat(", &call)
            .replace(" PIXEL", pixel_argument);
        let shader = match descriptor.map {
            MapKind::Flat(_) => shader.replace("shadows_visibility", "shadows_flat_visibility"),
            _ => shader,
        };
        let module = change(sampler.wgsl_module(1));
        let data: Vec<[f32; 8]> = points
            .iter()
            .enumerate()
            .map(|(i, (p, n))| {
                let [x, y] = pixel(i);
                [p.x, p.y, p.z, x, n.x, n.y, n.z, y]
            })
            .collect();
        let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&data),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let output = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * points.len() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((module + &shader).into()),
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
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, true), entry(1, false)],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout), Some(sampler.bind_group_layout())],
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
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: input.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: output.as_entire_binding(),
                },
            ],
        });
        Self {
            pipeline,
            group,
            output,
            count: points.len() as u32,
        }
    }

    /// Their visibility in what a map's bind group holds.
    pub fn ask(&self, gpu: &Gpu, map_group: &wgpu::BindGroup) -> Vec<f32> {
        gpu.run(|encoder| {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_bind_group(1, map_group, &[]);
            pass.dispatch_workgroups(self.count.div_ceil(64), 1, 1);
        });
        bytemuck::pod_collect_to_vec(&gpu.read_buffer(&self.output))
    }
}
