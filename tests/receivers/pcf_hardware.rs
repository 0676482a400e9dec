//! One comparison in hardware for four texels: no acne, and what that costs.

use crate::common::shapes::{Random, cuboid, square};
use crate::receivers::{ask_changed, visibility};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    AnyMap, Bias, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DirectionalLight,
    FlatLight, Kernel, MapSettings, PcfDescriptor, PointLight, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, SpotLight, glam,
};

const KERNEL: Kernel = Kernel::HardwareBilinear;

fn cube(gpu: &Gpu, size: u32, light: Vec3, casters: &[Caster]) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size,
        ..Default::default()
    };
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
    let frame = CubeFrame::new(PointLight::new(light, 300.0), casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn flat(gpu: &Gpu, size: u32, light: FlatLight, casters: &[Caster]) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size,
        settings: MapSettings {
            bias: Bias::default(),
            ..Default::default()
        },
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, casters))
        .unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

/// What a map says of points with its shader changed.
fn changed<'a>(
    gpu: &Gpu,
    map: impl Into<AnyMap<'a>>,
    points: &[(Vec3, Vec3)],
    change: fn(String) -> String,
) -> Vec<f32> {
    let map = map.into();
    let descriptor = PcfDescriptor {
        kernel: KERNEL,
        map: map.kind(),
        ..Default::default()
    };
    ask_changed(gpu, map, &descriptor, 0, points, change)
}

/// The depth of the plane at the receiver for all four texels.
fn without_slope(module: String) -> String {
    let same = module
        .replace("own + near * slope", "own")
        .replace("rise.x + rise.y", "0.0");
    assert_ne!(same, module);
    same
}

/// Points of a plane that the light falls on at an angle, the plane, and where the light is from.
fn plane(gpu: &Gpu, seed: u64, cosine: f32) -> (Vec<(Vec3, Vec3)>, Caster, Vec3) {
    let mut random = Random::new(seed);
    let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0 * random.next());
    let distance = (1.0 - cosine * cosine).sqrt() / cosine;
    let normal = turn.transform_vector3(Vec3::Y);
    // All round a light at a height of 1, so that edges and corners of a cube cross the plane.
    let points = (0..1500)
        .map(|_| {
            let (sine, cosine) = (3.15 * random.next()).sin_cos();
            let at = Vec3::new(cosine, 0.0, sine) * distance * (1.0 + 0.1 * random.next());
            (turn.transform_point3(at), normal)
        })
        .collect();
    (points, square(300.0).caster(&gpu.device, turn), normal)
}

#[test]
fn a_plane_does_not_shadow_itself_at_any_angle() {
    let Some(gpu) = Gpu::for_test() else { return };
    let acne = |seen: Vec<f32>| seen.into_iter().filter(|&lit| lit < 1.0).count();
    let mut without = 0;
    for (seed, cosine) in [1.0, 0.7, 0.3, 0.1, 0.03, 0.01].into_iter().enumerate() {
        let (points, caster, up) = plane(&gpu, 3 + seed as u64, cosine);
        let casters = [caster];
        for size in [64, 512, 2048] {
            let map = cube(&gpu, size, up, &casters);
            let seen = visibility(&gpu, &map, KERNEL, &points);
            assert_eq!(acne(seen), 0, "{cosine} {size}");
            without += acne(changed(&gpu, &map, &points, without_slope));
            // A spot and a sun along the ray to one of the points, and the points around that.
            let (middle, _) = points[0];
            let near: Vec<_> = points
                .iter()
                .copied()
                .filter(|(at, _)| at.distance(middle) < 0.3 * middle.distance(up))
                .collect();
            let ray = (middle - up).normalize();
            for light in [
                FlatLight::Spot(SpotLight::new(up, ray, 0.5, 300.0)),
                FlatLight::Directional(DirectionalLight::new(-ray)),
            ] {
                let map = flat(&gpu, size, light, &casters);
                let seen = visibility(&gpu, &map, KERNEL, &near);
                assert_eq!(acne(seen), 0, "{cosine} {size} {light:?}");
                without += acne(changed(&gpu, &map, &near, without_slope));
            }
        }
    }
    println!("dark without the slope: {without}");
    assert!(without > 1000, "the broken twin: {without}");
}

#[test]
fn it_is_lit_wherever_texels_compared_one_by_one_are() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A box on a floor that casts, too.
    let floor = square(10.0).caster(&gpu.device, Affine3A::IDENTITY);
    let stands = Affine3A::from_translation(Vec3::Y * 0.5) * Affine3A::from_rotation_y(0.4);
    let casters = [floor, cuboid(Vec3::splat(0.5)).caster(&gpu.device, stands)];
    let mut random = Random::new(6);
    let points: Vec<_> = (0..6000)
        .map(|_| Vec3::new(random.next(), 0.0, random.next()) * 2.0)
        .map(|at| (at, Vec3::Y))
        .collect();
    // Samplers blend with weights of 8 bits.
    let darker = |seen: &[f32], exact: &[f32]| {
        let pairs = seen.iter().zip(exact);
        pairs
            .filter(|(seen, exact)| **seen < **exact - 0.01)
            .count()
    };
    let light = Vec3::new(2.0, 3.0, -1.5);
    let map = cube(&gpu, 256, light, &casters);
    let spot = FlatLight::Spot(SpotLight::new(light, -light, 0.7, 300.0));
    let [spot, sun] = [spot, FlatLight::Directional(DirectionalLight::new(light))]
        .map(|light| flat(&gpu, 256, light, &casters));
    for map in [AnyMap::from(&map), (&spot).into(), (&sun).into()] {
        let exact = visibility(&gpu, map, Kernel::Bilinear, &points);
        let seen = visibility(&gpu, map, KERNEL, &points);
        assert_eq!(darker(&seen, &exact), 0, "{:?}", map.kind());
        let lighter = darker(&exact, &seen);
        println!("{:?}: {lighter} of {} lighter", map.kind(), seen.len());
        assert!(lighter < points.len() / 20, "{lighter}");
        // The broken twin: the plane farther away than it is.
        let broken = changed(&gpu, map, &points, |module| {
            module.replace("+ light.quantum;", "- 0.004 * own + light.quantum;")
        });
        assert!(darker(&broken, &exact) > 100, "{:?}", map.kind());
    }
}

#[test]
fn light_falls_in_behind_what_touches_as_far_as_a_texel_reaches() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut farthest: f32 = 0.0;
    for height in [0.5, 1.0, 2.0, 2.9] {
        let light = Vec3::new(-3.0, height, 0.1);
        let floor = square(10.0).caster(&gpu.device, Affine3A::IDENTITY);
        // A wall without any thickness, in the plane x = 0.5: the light is 3.5 away along the major axis.
        let upright = Affine3A::from_translation(Vec3::new(0.5, 0.5, 0.0))
            * Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2);
        let casters = [floor, square(0.5).caster(&gpu.device, upright)];
        for size in [256, 1024, 4096] {
            // What a texel covers of the floor, away from the light.
            let texel = 2.0 / size as f32 * 3.5 * 3.5 / height;
            let points: Vec<_> = (0..800)
                .map(|i| 5.0 * texel * i as f32 / 800.0)
                .map(|beyond| (Vec3::new(0.5 + beyond, 0.0, 0.37 * beyond), Vec3::Y))
                .collect();
            let map = cube(&gpu, size, light, &casters);
            let gap = |seen: Vec<f32>| {
                let lit = points.iter().zip(seen).filter(|(_, lit)| *lit >= 0.5);
                lit.map(|((at, _), _)| (at.x - 0.5) / texel)
                    .fold(0.0, f32::max)
            };
            let seen = gap(visibility(&gpu, &map, KERNEL, &points));
            let exact = gap(visibility(&gpu, &map, Kernel::Bilinear, &points));
            println!("height {height}, {size}: {seen} texels, one by one {exact}");
            // What the floor rises over 1.1 texels along the one axis that it is steep along.
            assert!(seen <= 1.2 + exact, "{height} {size}: {seen} {exact}");
            farthest = farthest.max(seen - exact);
        }
    }
    // It does fall in: the promise is not an empty one.
    assert!(farthest > 0.5, "{farthest}");
}
