//! What comes through to given points, read by a compute shader through the crate's own WGSL: no camera and
//! no rasteriser between the point that is asked for and the answer.

use shadows::glam::Vec3;
use shadows::{ProjectedShadow, wgpu};
use wgpu::util::DeviceExt as _;

use host::gpu::Gpu;

/// A point that may receive a shadow.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub position: Vec3,
    /// To the next pixels.
    pub x: Vec3,
    pub y: Vec3,
    /// Geometric, where the shader has one.
    pub normal: Option<Vec3>,
}

impl Point {
    /// Read from the finest level.
    pub fn at(position: Vec3) -> Self {
        Self {
            position,
            x: Vec3::ZERO,
            y: Vec3::ZERO,
            normal: None,
        }
    }

    /// As seen through pixels of a size, across two axes.
    pub fn seen(self, x: Vec3, y: Vec3) -> Self {
        Self { x, y, ..self }
    }

    pub fn facing(self, normal: Vec3) -> Self {
        Self {
            normal: Some(normal),
            ..self
        }
    }
}

// In a branch that only some invocations take, where no derivative could be asked for.
const SHADER: &str = "
struct Point { position: vec3f, facing: f32, x: vec3f, y: vec3f, normal: vec3f }
@group(0) @binding(0) var<storage, read> points: array<Point>;
@group(0) @binding(1) var<storage, read_write> through: array<vec4f>;
@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&through) {
        let point = points[id.x];
        let at = point.position;
        if point.facing > 0.0 {
            let lit = shadows_transmittance_facing(PROJECTOR, at, point.normal, point.x, point.y);
            through[id.x] = vec4f(lit, 1.0);
        } else {
            through[id.x] = vec4f(shadows_transmittance(PROJECTOR, at, point.x, point.y), 1.0);
        }
    }
}
";

/// Of red, green and blue light what comes from one projector to each point.
pub fn ask(
    gpu: &Gpu,
    shadow: &ProjectedShadow,
    projector: usize,
    points: &[Point],
) -> Vec<[f32; 3]> {
    ask_changed(gpu, shadow, projector, points, |module| module)
}

/// The same with the module changed, for tests of what must fail.
pub fn ask_changed(
    gpu: &Gpu,
    shadow: &ProjectedShadow,
    projector: usize,
    points: &[Point],
    change: impl FnOnce(String) -> String,
) -> Vec<[f32; 3]> {
    let device = &gpu.device;
    let module = change(shadow.wgsl_module(1));
    let shader = SHADER.replace("PROJECTOR", &format!("{projector}u"));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl((module + &shader).into()),
    });
    let data: Vec<[[f32; 4]; 4]> = points
        .iter()
        .map(|point| {
            let facing = f32::from(u8::from(point.normal.is_some()));
            let normal = point.normal.unwrap_or(Vec3::ZERO);
            [
                point.position.extend(facing).to_array(),
                point.x.extend(0.0).to_array(),
                point.y.extend(0.0).to_array(),
                normal.extend(0.0).to_array(),
            ]
        })
        .collect();
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&data),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let output = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16 * points.len() as u64,
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
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[entry(0, true), entry(1, false)],
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout), Some(shadow.bind_group_layout())],
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
    let resource = |binding, buffer: &wgpu::Buffer| (binding, buffer.clone());
    let buffers = [resource(0, &input), resource(1, &output)];
    let entries: Vec<wgpu::BindGroupEntry<'_>> = buffers
        .iter()
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries,
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_bind_group(1, shadow.bind_group(), &[]);
        pass.dispatch_workgroups((points.len() as u32).div_ceil(64), 1, 1);
    });
    let read: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(&output));
    read.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()
}
