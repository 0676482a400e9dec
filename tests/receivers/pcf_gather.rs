//! Found 16: square kernels without texture gathers, which WebGL 2 does not have. They see, bit for bit, what they see with them.

use crate::common::shapes::{Random, cuboid};
use crate::pcf::SQUARES;
use crate::receivers::ask_changed;
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    AnyMap, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding,
    DirectionalLight, FlatLight, Gather, Kernel, MapKind, PcfDescriptor, PointLight, ShadowFrame,
    ShadowMap, ShadowMapDescriptor, SpotLight, glam,
};

/// Boxes on all sides of the light.
fn casters(gpu: &Gpu) -> Vec<Caster> {
    let mut random = Random::new(3);
    let mesh = cuboid(Vec3::new(0.3, 0.2, 0.25)).mesh(&gpu.device);
    (0..40)
        .map(|_| {
            let place = random.vec3().normalize() * 1.5;
            let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0);
            Caster::new(mesh.clone(), Affine3A::from_translation(place) * turn)
        })
        .collect()
}

/// Points around the light with their normals, on all faces, over edges and corners, lit and not.
fn points() -> Vec<(Vec3, Vec3)> {
    let mut random = Random::new(8);
    (0..20_000)
        .map(|_| {
            let place = random.vec3();
            let wall = place / place.abs().max_element() * 4.0;
            (wall, random.vec3())
        })
        .collect()
}

fn cube(gpu: &Gpu, encoding: DepthEncoding) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size: 64,
        encoding,
        ..Default::default()
    };
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
    let light = PointLight::new(Vec3::ZERO, 30.0);
    let casters = casters(gpu);
    let frame = CubeFrame::new(light, &casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn flat(gpu: &Gpu, light: FlatLight) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size: 64,
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    let casters = casters(gpu);
    map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, &casters))
        .unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

/// What every square sees of a map with gathers and without, and how much of it is neither lit nor
/// unlit. The last time as a broken twin sees it, whose `wrong` fetch is another.
fn compare<'a>(
    gpu: &Gpu,
    map: impl Into<AnyMap<'a>>,
    base: &PcfDescriptor<'_>,
    (right, wrong): (&str, &str),
) {
    let map = map.into();
    let points = points();
    for kernel in SQUARES {
        let see = |gather, change: &dyn Fn(String) -> String| {
            let descriptor = PcfDescriptor {
                kernel,
                gather,
                ..base.clone()
            };
            ask_changed(gpu, map, &descriptor, 0, &points, change)
        };
        let with = see(Gather::Always, &|module| {
            assert!(module.contains("textureGather"));
            module
        });
        let without = see(Gather::Never, &|module| {
            assert!(!module.contains("textureGather"));
            module
        });
        let partly = with.iter().filter(|&&lit| lit > 0.0 && lit < 1.0).count();
        assert!(partly > 100, "{kernel:?}: {partly}");
        let differ = |other: &[f32]| with.iter().zip(other).filter(|(a, b)| a != b).count();
        assert_eq!(differ(&without), 0, "{kernel:?} of {base:?}");
        let twin = see(Gather::Never, &|module| {
            assert!(module.contains(right));
            module.replace(right, wrong)
        });
        assert!(differ(&twin) > 40, "{kernel:?}: {}", differ(&twin));
    }
}

#[test]
fn cubes_are_seen_alike_with_and_without_gathers() {
    let Some(gpu) = Gpu::for_test() else { return };
    for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
        let map = cube(&gpu, encoding);
        let base = PcfDescriptor {
            map: MapKind::Cube(encoding),
            ..Default::default()
        };
        compare(
            &gpu,
            &map,
            &base,
            ("vec2f(least.x, most.y)", "vec2f(most.x, most.y)"),
        );
    }
}

#[test]
fn flat_maps_are_seen_alike_with_and_without_gathers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (position, direction) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(1.0, 0.4, 0.2));
    let spot = FlatLight::Spot(SpotLight::new(position, direction, 0.9, 30.0));
    let sun = FlatLight::Directional(DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2)));
    let base = PcfDescriptor {
        map: MapKind::FLAT,
        kernel: Kernel::Bilinear,
        ..Default::default()
    };
    for light in [spot, sun] {
        let map = flat(&gpu, light);
        compare(
            &gpu,
            &map,
            &base,
            ("vec2f(least.x, most.y)", "vec2f(most.x, most.y)"),
        );
    }
}
