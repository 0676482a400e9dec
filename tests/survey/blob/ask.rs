//! The function at given points, and what is true there.

use shadows::glam::{DMat3, Vec3, Vec4Swizzles as _};
use shadows::{Blob, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor, wgpu};
use wgpu::util::DeviceExt as _;

use host::gpu::Gpu;

const SHADER: &str = "
@group(0) @binding(0) var<storage, read> points: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> visibility: array<f32>;
@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&visibility) {
        let asked = bitcast<vec4u>(points[2u * id.x + 1u]);
        visibility[id.x] = shadows_blob_visibility_of(asked.x, points[2u * id.x].xyz, asked.y);
    }
}
";

/// A question: visibility of a light, by its place in the frame, at a point, without one of the blobs.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    pub at: Vec3,
    pub light: u32,
    pub own: u32,
}

impl Question {
    pub fn of(at: Vec3, light: u32) -> Self {
        Self {
            at,
            light,
            own: u32::MAX,
        }
    }
}

/// What the shader answers.
pub fn answers(gpu: &Gpu, frame: &BlobFrame<'_>, questions: &[Question]) -> Vec<f32> {
    answers_of(gpu, 6, frame, questions, |text| text)
}

/// The same by so many strips, of a module that is changed, for what must fail.
pub fn answers_of(
    gpu: &Gpu,
    strips: u32,
    frame: &BlobFrame<'_>,
    questions: &[Question],
    change: impl FnOnce(String) -> String,
) -> Vec<f32> {
    let device = &gpu.device;
    let descriptor = BlobShadowDescriptor {
        lights: 256,
        strips,
        ..Default::default()
    };
    let mut shadow = BlobShadow::new(device, &descriptor).unwrap();
    shadow.prepare(device, &gpu.queue, frame).unwrap();
    gpu.run(|encoder| shadow.encode(encoder));
    let data: Vec<[f32; 8]> = questions
        .iter()
        .map(|q| {
            let [light, own] = [q.light, q.own].map(f32::from_bits);
            [q.at.x, q.at.y, q.at.z, 0.0, light, own, 0.0, 0.0]
        })
        .collect();
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&data),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let output = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4 * questions.len() as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let text = shadow.wgsl_module(1);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl((change(text) + SHADER).into()),
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
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&own), shadow.bind_group_layout()],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layout),
        module: &module,
        entry_point: Some("ask"),
        compilation_options: Default::default(),
        cache: None,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &own,
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
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_bind_group(1, shadow.bind_group(), &[]);
        pass.dispatch_workgroups((questions.len() as u32).div_ceil(64), 1, 1);
    });
    bytemuck::pod_collect_to_vec(&gpu.read_buffer(&output))
}

/// The part of a light's disk that reaches a point past an ellipsoid, by rays to places on a spiral of golden
/// angles (Vogel 1979). Not for points and lights inside.
pub fn truth(blob: &Blob, light: &BlobLight, at: Vec3, samples: u32) -> f64 {
    let [x, y, z] = blob.axes.map(|axis| axis.as_dvec3());
    let unit = DMat3::from_cols(x, y, z).inverse();
    let q = unit * (at.as_dvec3() - blob.centre.as_dvec3());
    let place = light.light.xyzw().as_dvec4();
    let toward = place.xyz() - place.w * at.as_dvec3();
    let (across, along) = toward.normalize().any_orthonormal_pair();
    let radius = match place.w {
        0.0 => f64::from(light.radius) * toward.length(),
        _ => f64::from(light.radius),
    };
    let blocked = (0..samples).filter(|&sample| {
        let angle = f64::from(sample) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let out = radius * ((f64::from(sample) + 0.5) / f64::from(samples)).sqrt();
        let to = toward + out * (angle.cos() * across + angle.sin() * along);
        let m = unit * to;
        // |q + t m|^2 = 1
        let (a, b, c) = (m.dot(m), q.dot(m), q.dot(q) - 1.0);
        let discriminant = b * b - a * c;
        let first = (-b - discriminant.max(0.0).sqrt()) / a;
        discriminant > 0.0 && first > 0.0 && (place.w == 0.0 || first < 1.0)
    });
    1.0 - blocked.count() as f64 / f64::from(samples)
}

/// Root mean square, and the largest, of differences.
pub fn errors(shown: &[f32], truth: &[f64]) -> [f64; 2] {
    assert_eq!(shown.len(), truth.len());
    let each = || shown.iter().zip(truth).map(|(s, t)| f64::from(*s) - t);
    let squares: f64 = each().map(|e| e * e).sum();
    // NaN would be lost in `max`.
    assert!(shown.iter().all(|s| (0.0..=1.0).contains(s)));
    let largest = each().fold(0.0, |largest: f64, e| largest.max(e.abs()));
    [(squares / truth.len() as f64).sqrt(), largest]
}
