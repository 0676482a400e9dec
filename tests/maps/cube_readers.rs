//! Cube maps beside what reads them, what they count, and what they put off that no view shows.

use crate::common::shapes::{Random, cuboid};
use crate::cubes::{draw, draw_frame, fresh};
use crate::receivers::{ask, ask_group};
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::PcfError;
use shadows::{
    Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthConvention, DepthEncoding,
    MapKind, PcfDescriptor, PcfSampler, PointLight, View, glam,
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
        map: MapKind::Cube(DepthEncoding::LinearDistance),
        ..Default::default()
    };
    let expected = PcfError::Map {
        made_for: MapKind::Cube(DepthEncoding::LinearDistance),
        given: MapKind::CUBE,
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

fn looking(eye: Vec3, target: Vec3) -> View {
    let projection = proj::perspective_infinite_reverse(1.2, 1.0, 0.1);
    let matrix = projection * view::look_at_mat4(eye, target, Vec3::Y);
    View::new(matrix, DepthConvention::InfiniteReverse).unwrap()
}

#[test]
fn faces_that_no_view_shows_wait_until_one_does() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = casters(&gpu);
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor(32)).unwrap();
    let away = looking(Vec3::X * 30.0, Vec3::X * 40.0);
    let toward = looking(Vec3::X * 30.0, Vec3::ZERO);
    let mut random = Random::new(31);
    let points: Vec<(Vec3, Vec3)> = (0..1000)
        .map(|_| (random.vec3() * 6.0, random.vec3()))
        .collect();
    let seen = |map: &CubeShadowMap| ask(&gpu, map, &PcfDescriptor::default(), 0, &points);
    let mut frame = |light, view| {
        let frame = CubeFrame {
            view: Some(view),
            ..CubeFrame::new(light, &casters)
        };
        draw_frame(&gpu, &mut map, &frame);
        let s = map.statistics();
        ((s.faces_rendered, s.faces_hidden), seen(&map))
    };
    let right = |light| seen(&fresh(&gpu, &descriptor(32), light, &casters));
    assert_eq!(frame(LIGHT, &away).0, (0, 6));
    assert_eq!(frame(LIGHT, &toward), ((6, 0), right(LIGHT)));
    let moved = PointLight {
        position: LIGHT.position + Vec3::splat(0.4),
        ..LIGHT
    };
    let (faces, waiting) = frame(moved, &away);
    assert_eq!(faces, (0, 6));
    assert_ne!(waiting, right(moved), "the broken twin: nobody looks");
    assert_eq!(frame(moved, &toward), ((6, 0), right(moved)));
}
