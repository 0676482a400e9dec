//! Shadows projected onto the scene's ground, which alone receives them.

use anyhow::{Context as _, Result};
use serde_json::{Value, json};
use shadows::glam::{DVec3, Vec3};
use shadows::reference::Interior;
use shadows::{
    DirectionalLight, Light, PlanarFrame, PlanarLight, PlanarOutline, PlanarReceiver, PlanarShadow,
    PlanarShadowDescriptor, wgpu,
};

use super::SurveyShadow;
use crate::shadow::{Cost, ShadowInputs};
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene::{Bounds, Object, Scene};
use host::scene_gpu::SceneGpu;

/// Everything that was chosen, by name.
pub fn settings() -> Value {
    let chosen = PlanarShadowDescriptor::default();
    json!({
        "technique": "planar",
        "bias_pixels": chosen.bias_pixels,
        "bias_ulps": chosen.bias_ulps,
    })
}

struct Planar(PlanarShadow);

/// Makes it, and the lit pass that tests the stencil.
///
/// # Errors
/// If the device cannot do it.
pub fn make(gpu: &Gpu, renderer: &Renderer) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
    let descriptor = PlanarShadowDescriptor {
        depth_stencil_format: renderer.depth_stencil_format(),
        depth: renderer.look().depth,
        sample_count: renderer.look().samples,
        ..Default::default()
    };
    let planar = PlanarShadow::new(&gpu.device, &descriptor)?;
    let access = ShadowAccess {
        stencil: Some(planar.light_pass_stencil()),
        ..Default::default()
    };
    let lit = renderer.lit_pipeline(gpu, &access);
    Ok((Box::new(Planar(planar)), lit))
}

impl SurveyShadow for Planar {
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let ground = inputs.ground.as_ref().context(NO_GROUND)?;
        let frame = PlanarFrame {
            lights: &[PlanarLight::new(light(inputs))],
            planes: &[PlanarReceiver {
                point: ground[0],
                normal: Vec3::Y,
                outline: PlanarOutline::Polygon(ground),
            }],
            views: &[inputs.view],
            casters: &inputs.casters,
        };
        Ok(self.0.prepare(&gpu.device, &gpu.queue, &frame)?)
    }

    fn generate(&mut self, host: &Renderer, _: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        self.0.encode(encoder);
        let mut pass = host.begin_stencil_pass(encoder);
        self.0.render(&mut pass, 0, 0, 0).expect("it is encoded");
    }

    fn group(&self) -> Option<&wgpu::BindGroup> {
        None
    }

    fn cost(&self) -> Cost {
        let taken = self.0.statistics();
        Cost {
            bytes: taken.bytes,
            draws: taken.draws.into(),
            triangles: taken.triangles,
        }
    }

    fn interior(&self) -> Interior {
        Interior::Screen
    }
}

/// Why a scene has none.
pub const NO_GROUND: &str =
    "planar shadows need a flat, rectangular ground that casts nothing, and this scene has none";

/// The light, of whatever kind.
pub fn light(inputs: &ShadowInputs) -> Light {
    match inputs.spot_light() {
        Some(spot) => spot.into(),
        None if inputs.light.is_directional() => {
            DirectionalLight::new(inputs.light.xyzw().truncate()).into()
        }
        None => inputs.point_light().into(),
    }
}

/// The corners of the largest horizontal rectangle on top of an object that casts nothing.
pub fn ground(scene: &Scene) -> Option<[Vec3; 4]> {
    let grounds = scene.objects.iter().filter(|object| !object.casts);
    let tops = grounds.filter_map(|object| top(scene, object));
    let (_, corners) = tops.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(corners)
}

/// The top of an object, if it is a rectangle, and its area.
fn top(scene: &Scene, object: &Object) -> Option<(f64, [Vec3; 4])> {
    let Bounds { min, max } = Bounds::of(scene.world_points(object));
    let mesh = &scene.meshes[object.mesh];
    let corner = |index: u32| object.world_point(mesh.positions[index as usize]);
    let covered: f64 = mesh
        .triangles()
        .map(|triangle| triangle.map(corner))
        .filter(|corners| corners.iter().all(|corner| corner.y == max.y))
        .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
        .sum();
    let area = (max.x - min.x) * (max.z - min.z);
    let corners = [
        DVec3::new(min.x, max.y, min.z),
        DVec3::new(min.x, max.y, max.z),
        DVec3::new(max.x, max.y, max.z),
        DVec3::new(max.x, max.y, min.z),
    ];
    let is_rectangle = area > 0.0 && (covered - area).abs() < 1e-6 * area;
    is_rectangle.then(|| (area, corners.map(|corner| corner.as_vec3())))
}
