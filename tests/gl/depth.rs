//! Depth on GL, which goes through `2 z - w`: how much of reverse-Z is left, and that receivers know it.

use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{
    CubeShadowMap, CubeShadowMapDescriptor, Kernel, PcfDescriptor, PcfSampler, PointLight,
};

use crate::common::shapes::square;
use crate::host::gpu::Gpu;
use crate::receivers::ask_changed;
use crate::{cubes, gl};

const SIZE: u32 = 64;

/// A light over the origin, and a large square through it that leans.
struct Ground {
    light: PointLight,
    normal: Vec3,
    map: CubeShadowMap,
}

impl Ground {
    fn new(gpu: &Gpu, height: f32, near: Option<f32>, range: f32, lean: f32) -> Self {
        let light = PointLight {
            near,
            ..PointLight::new(Vec3::Y * height, range)
        };
        let turn = Quat::from_rotation_z(lean) * Quat::from_rotation_x(0.6 * lean);
        let ground = square(4.0 * height).caster(&gpu.device, Affine3A::from_quat(turn));
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            ..Default::default()
        };
        Self {
            light,
            normal: turn * Vec3::Y,
            map: cubes::fresh(gpu, &descriptor, &[light], &[ground]),
        }
    }

    /// The largest difference of a stored depth below the light from the exact one.
    fn error(&self, gpu: &Gpu, near: f32) -> f64 {
        let source = format!(
            "@group(1) @binding(0) var map: texture_cube<f32>;
            @group(1) @binding(1) var nearest: sampler;
            fn ask(i: u32) -> f32 {{
                let at = (vec2f(f32(i % {SIZE}u), f32(i / {SIZE}u)) + 0.5) * (2.0 / {SIZE}.0) - 1.0;
                return textureSampleLevel(map, nearest, vec3f(at.x, -1.0, at.y), 0.0).x;
            }}"
        );
        let hard = PcfDescriptor {
            kernel: Kernel::Hard,
            ..Default::default()
        };
        let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &hard).unwrap();
        let group = sampler.bind_group(&gpu.device, &self.map).unwrap();
        let own = (sampler.bind_group_layout(), &group);
        let stored = crate::ask(gpu, &source, own, SIZE * SIZE);
        let normal = self.normal.as_dvec3();
        let height = normal.dot(self.light.position.as_dvec3());
        let exact = |i: usize| {
            let at = |i: usize| (i as f64 + 0.5) * 2.0 / f64::from(SIZE) - 1.0;
            let ray = shadows::glam::DVec3::new(at(i % SIZE as usize), -1.0, at(i / SIZE as usize));
            f64::from(near) * -normal.dot(ray) / height
        };
        let errors = stored.iter().enumerate();
        let errors = errors.map(|(i, &depth)| (f64::from(depth) - exact(i)).abs());
        errors.fold(0.0, f64::max)
    }

    /// The share of points on the square that a module says are in shadow, which none is.
    fn acne(&self, gpu: &Gpu, change: impl FnOnce(String) -> String) -> f32 {
        let mut random = crate::common::shapes::Random::new(5);
        let height = self.light.position.y;
        let points: Vec<_> = (0..4000)
            .map(|_| {
                let across = Vec3::new(random.next(), 0.0, random.next()) * 1.2 * height;
                let up = -(self.normal.x * across.x + self.normal.z * across.z) / self.normal.y;
                (across + Vec3::Y * up, self.normal)
            })
            .collect();
        let descriptor = PcfDescriptor {
            kernel: Kernel::Weighted3,
            ..Default::default()
        };
        let map = (&self.map).into();
        let seen = ask_changed(gpu, map, &descriptor, 0, &points, change);
        seen.iter().filter(|&&lit| lit < 1.0).count() as f32 / points.len() as f32
    }
}

/// 2^-24.
const STEP: f64 = 1.0 / 16_777_216.0;

#[test]
fn depths_are_as_coarse_as_fixed_point_with_23_bits() {
    let Some(gpu) = gl() else { return };
    let mut worst: f64 = 0.0;
    for near in [1.0, 1e-2, 1e-4, 1e-6] {
        for (height, lean) in [(1.1, 0.0), (3.7, 0.2), (37.0, 0.3), (100.0, 0.0)] {
            let ground = Ground::new(&gpu, height, Some(near), 1e4, lean);
            let error = ground.error(&gpu, near) / STEP;
            println!("near {near}, {height} away: {error:.2} steps of 2^-24");
            worst = worst.max(error);
        }
    }
    println!("worst {worst:.2}");
    assert!(worst <= 2.0, "{worst}");
    // The broken twin: where depths are what they seem, the same bound is not reached by far.
    assert!(worst > 0.5, "{worst}");
    if let Ok(vulkan) = Gpu::new(Some("(vulkan,")) {
        let ground = Ground::new(&vulkan, 37.0, Some(1e-4), 1e4, 0.3);
        let error = ground.error(&vulkan, 1e-4) / STEP;
        assert!(error < 1e-3, "{error}");
    }
}

#[test]
fn receivers_have_no_acne_from_it_at_any_near_plane() {
    let Some(gpu) = gl() else { return };
    let mut without = Vec::new();
    for near in [None, Some(1.0), Some(1e-2), Some(1e-4), Some(1e-5)] {
        for (height, lean) in [(1.1, 0.0), (3.7, 0.2), (30.0, 0.3)] {
            let ground = Ground::new(&gpu, height, near, 100.0, lean);
            let acne = ground.acne(&gpu, |module| module);
            // The broken twin: receivers that take depths for floats.
            let twin = ground.acne(&gpu, |module| {
                let known = "receiver.quantum = light.quantum;";
                assert!(module.contains(known));
                module.replace(known, "receiver.quantum = 0.0;")
            });
            println!("near {near:?}, {height} away: {acne}, as floats {twin}");
            assert_eq!(acne, 0.0, "{near:?} {height}");
            without.push(twin);
        }
    }
    assert!(without.iter().any(|&acne| acne > 0.05), "{without:?}");
}
