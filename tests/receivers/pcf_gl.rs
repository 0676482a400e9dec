//! Every kernel on the GL back end: the same visibility as on the first one, away from cube edges.

use crate::common::shapes::{Random, cuboid};
use crate::receivers::{ask, visibility};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    AtlasFrame, AtlasLight, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor,
    DirectionalLight, FlatLight, Kernel, MapKind, PcfDescriptor, PointLight, ShadowAtlas,
    ShadowAtlasDescriptor, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight, TileSize, glam,
    wgpu,
};

const LIGHT: Vec3 = Vec3::new(0.0, 3.0, 0.0);

fn casters(gpu: &Gpu) -> Vec<Caster> {
    let mut random = Random::new(21);
    let mesh = cuboid(Vec3::new(0.25, 0.15, 0.2)).mesh(&gpu.device);
    (0..10)
        .map(|_| {
            let place = random.vec3() * Vec3::new(1.2, 0.5, 1.2) + Vec3::Y * 0.8;
            let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0);
            Caster::new(mesh.clone(), Affine3A::from_translation(place) * turn)
        })
        .collect()
}

fn cube(gpu: &Gpu, casters: &[Caster]) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size: 256,
        ..Default::default()
    };
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
    let frame = CubeFrame::new(PointLight::new(LIGHT, 30.0), casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn flat(gpu: &Gpu, light: FlatLight, casters: &[Caster]) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size: 256,
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, casters))
        .unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

/// The same three lights in one texture.
fn atlas(gpu: &Gpu, casters: &[Caster]) -> ShadowAtlas {
    let descriptor = ShadowAtlasDescriptor {
        layer_size: 512,
        memory: 8 << 20,
        ..Default::default()
    };
    let mut atlas = ShadowAtlas::new(&gpu.device, &descriptor).unwrap();
    let spot = SpotLight::new(LIGHT, Vec3::NEG_Y, std::f32::consts::FRAC_PI_4, 30.0);
    let sun = DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2));
    let lights = [
        AtlasLight::new(PointLight::new(LIGHT, 30.0)),
        AtlasLight::new(spot),
        AtlasLight::directional(sun, Default::default()),
    ]
    .map(|light| light.with_size(TileSize::Fixed(256)));
    let frame = AtlasFrame {
        lights: &lights,
        casters,
        ..Default::default()
    };
    atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| atlas.encode(encoder));
    atlas
}

/// What every kernel says of points on the ground, for a cube map, a spot and a directional light.
fn seen(gpu: &Gpu, shift: Vec3) -> Vec<(String, Vec<f32>)> {
    let mut random = Random::new(4);
    // One face of the cube sees them all, and none is within a kernel of the face's edge.
    let points: Vec<_> = (0..2000)
        .map(|_| Vec3::new(random.next() * 2.2, 0.0, random.next() * 2.2))
        .map(|point| (point + shift, Vec3::Y))
        .collect();
    let casters = casters(gpu);
    let spot = FlatLight::Spot(SpotLight::new(
        LIGHT,
        Vec3::NEG_Y,
        std::f32::consts::FRAC_PI_4,
        30.0,
    ));
    let sun = FlatLight::Directional(DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2)));
    let atlas = atlas(gpu, &casters);
    let cube = cube(gpu, &casters);
    let [spot, sun] = [spot, sun].map(|light| flat(gpu, light, &casters));
    let in_atlas = |kernel, light| {
        let descriptor = PcfDescriptor {
            kernel,
            map: MapKind::ATLAS,
            ..Default::default()
        };
        ask(gpu, &atlas, &descriptor, light, &points)
    };
    let mut all = Vec::new();
    for kernel in Kernel::ALL {
        for (name, seen) in [
            ("cube", visibility(gpu, &cube, kernel, &points)),
            ("spot", visibility(gpu, &spot, kernel, &points)),
            ("sun", visibility(gpu, &sun, kernel, &points)),
            ("point light of an atlas", in_atlas(kernel, 0)),
            ("spot of an atlas", in_atlas(kernel, 1)),
            ("sun of an atlas", in_atlas(kernel, 2)),
        ] {
            all.push((format!("{name} {kernel:?}"), seen));
        }
    }
    all
}

/// Root mean square difference.
fn difference(a: &[f32], b: &[f32]) -> f32 {
    let squares: f32 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / a.len() as f32).sqrt()
}

#[test]
fn every_kernel_says_on_gl_what_it_says_elsewhere() {
    let Some(gpu) = Gpu::for_test() else { return };
    let Ok(gl) = Gpu::new(Some("(gl,")) else {
        eprintln!("skipped: no GL adapter");
        return;
    };
    assert_eq!(gl.info.backend, wgpu::Backend::Gl);
    let (first, second) = (seen(&gpu, Vec3::ZERO), seen(&gl, Vec3::ZERO));
    // The broken twin: the ground a texel beside.
    let beside = seen(&gl, Vec3::X * (6.0 / 256.0));
    for (((name, first), (_, second)), (_, beside)) in first.iter().zip(&second).zip(&beside) {
        let (same, other) = (difference(first, second), difference(first, beside));
        println!("{name}: {same:.5}; a texel beside: {other:.4}");
        let shadowed = first.iter().filter(|&&lit| lit < 0.5).count();
        assert!(shadowed > 100, "{name}: {shadowed}");
        assert!(same < 0.005, "{name}: {same}");
        assert!(other > 0.02, "{name}: {other}");
    }
}
