//! Cube maps beside what reads them, and what they count.

use crate::common::shapes::{Random, cuboid};
use crate::cubes::{draw, fresh};
use crate::receivers::{ask, ask_group};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::PcfError;
use shadows::{
    Caster, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, PcfDescriptor, PcfSampler,
    PointLight, glam,
};

const LIGHT: PointLight = PointLight {
    position: Vec3::new(0.0, 0.3, 0.2),
    range: 8.0,
    near: None,
};

fn descriptor(size: u32) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size,
        ..Default::default()
    }
}

fn casters(gpu: &Gpu) -> Vec<Caster> {
    let mesh = cuboid(Vec3::splat(0.6)).mesh(&gpu.device);
    let mut random = Random::new(5);
    let place = |_| Affine3A::from_translation(random.vec3() * 5.0);
    (0..20)
        .map(place)
        .map(|at| Caster::new(mesh.clone(), at))
        .collect()
}

#[test]
fn maps_of_different_sizes_share_a_sampler() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = casters(&gpu);
    let reader = PcfDescriptor::default();
    let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &reader).unwrap();
    let mut random = Random::new(23);
    let points: Vec<(Vec3, Vec3)> = (0..2000)
        .map(|_| (random.vec3() * 6.0, random.vec3()))
        .collect();
    let seen = [16, 64].map(|size| {
        let map = fresh(&gpu, &descriptor(size), LIGHT, &casters);
        assert_eq!(map.texture().width(), size);
        let group = gpu.checked(|| sampler.bind_group(&gpu.device, &map).unwrap());
        let seen = ask_group(&gpu, (&sampler, &group), &reader, 0, &points, |m| m);
        assert_eq!(
            seen,
            ask(&gpu, &map, &reader, 0, &points),
            "a sampler of its own"
        );
        seen
    });
    assert_ne!(seen[0], seen[1], "the broken twin: the other map");
}

#[test]
fn samplers_refuse_maps_that_they_cannot_read() {
    let Some(gpu) = Gpu::for_test() else { return };
    let map = CubeShadowMap::new(&gpu.device, &descriptor(32)).unwrap();
    let refused = |descriptor: &PcfDescriptor<'_>| {
        PcfSampler::new(&gpu.device, &gpu.queue, descriptor)
            .unwrap()
            .bind_group(&gpu.device, &map)
            .unwrap_err()
    };
    let linear = PcfDescriptor {
        encoding: DepthEncoding::LinearDistance,
        ..Default::default()
    };
    let expected = PcfError::Encoding {
        map: DepthEncoding::MajorAxis,
        sampler: DepthEncoding::LinearDistance,
    };
    assert_eq!(refused(&linear), expected);
    let good = PcfSampler::new(&gpu.device, &gpu.queue, &PcfDescriptor::default()).unwrap();
    good.bind_group(&gpu.device, &map).unwrap();
}

#[test]
fn statistics_count_every_face_once() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = casters(&gpu);
    let mut map = fresh(&gpu, &descriptor(32), LIGHT, &casters);
    for round in 0..2 {
        let s = map.statistics();
        let faces = s.faces_rendered + s.faces_kept + s.faces_empty + s.faces_hidden;
        assert_eq!(faces, 6);
        assert_eq!(s.casters_in_range + s.casters_out_of_range, 20);
        if round == 0 {
            assert_eq!(s.faces_rendered, 6);
            assert!(s.draws > 3 && s.triangles >= 12 * 20 && s.triangles.is_multiple_of(12));
        } else {
            assert_eq!((s.faces_rendered, s.draws, s.triangles), (0, 0, 0));
        }
        draw(&gpu, &mut map, LIGHT, &casters);
    }
}
