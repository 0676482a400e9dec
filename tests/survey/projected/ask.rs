//! What comes through to given points, by the crate's own WGSL.

use shadows::ProjectedShadow;
use shadows::glam::Vec3;

use crate::ask::answers_by;
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
    let shader = SHADER.replace("PROJECTOR", &format!("{projector}u"));
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
    let group = (shadow.bind_group_layout(), shadow.bind_group());
    let module = change(shadow.wgsl_module(1)) + &shader;
    let through: Vec<[f32; 4]> = answers_by(gpu, module, group, &data);
    through.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()
}
