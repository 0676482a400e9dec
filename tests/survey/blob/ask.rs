//! The function at given points, and what is true there.

use shadows::glam::{DMat3, Vec3, Vec4Swizzles as _};
use shadows::{Blob, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor};

use crate::ask::answers_by;
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
    let descriptor = BlobShadowDescriptor {
        lights: 256,
        strips,
        ..Default::default()
    };
    let mut shadow = BlobShadow::new(&gpu.device, &descriptor).unwrap();
    shadow.prepare(&gpu.device, &gpu.queue, frame).unwrap();
    gpu.run(|encoder| shadow.encode(encoder));
    answers_from(gpu, &shadow, questions, change)
}

/// The same of what was prepared and encoded.
pub fn answers_from(
    gpu: &Gpu,
    shadow: &BlobShadow,
    questions: &[Question],
    change: impl FnOnce(String) -> String,
) -> Vec<f32> {
    let data: Vec<[f32; 8]> = questions
        .iter()
        .map(|q| {
            let [light, own] = [q.light, q.own].map(f32::from_bits);
            [q.at.x, q.at.y, q.at.z, 0.0, light, own, 0.0, 0.0]
        })
        .collect();
    let group = (
        shadow.bind_group_layout().unwrap(),
        shadow.bind_group().unwrap(),
    );
    answers_by(gpu, change(shadow.wgsl_module(1)) + SHADER, group, &data)
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
