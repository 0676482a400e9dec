//! Several faces in one pass: the same bits as a pass for each.

mod common;
#[path = "common/cubes.rs"]
mod cubes;
#[path = "../examples/host/mod.rs"]
mod host;

use common::shapes::{Random, cuboid, sphere};
use common::{noop, noop_with};
use cubes::{draw, draw_frame, faces, fresh};
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::CubeShadowMapError;
use shadows::{
    Caster, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthConvention,
    DepthEncoding, FacePasses, PointLight, Radius, View, glam, wgpu,
};

const SIZE: u32 = 64;
const LIGHT: PointLight = PointLight {
    position: Vec3::new(0.1, -0.2, 0.3),
    range: 40.0,
    near: None,
};

/// A device that can draw several views at once; `None` (said on stderr) where there is none.
fn gpu() -> Option<Gpu> {
    let gpu = Gpu::for_test()?;
    if !gpu.support.multiview {
        eprintln!(
            "skipped: {} has no multiview",
            host::gpu::describe(&gpu.info)
        );
    }
    gpu.support.multiview.then_some(gpu)
}

fn descriptor(passes: FacePasses) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: SIZE,
        passes,
        ..Default::default()
    }
}

/// Boxes and balls all around, most of them across the edges and corners of the faces, some of them
/// around the light.
fn clutter(gpu: &Gpu, count: usize, seed: u64) -> Vec<Caster> {
    let mut random = Random::new(seed);
    let meshes = [cuboid(Vec3::splat(0.5)), sphere(5, 7)].map(|shape| shape.mesh(&gpu.device));
    let place = |i: usize| {
        let spin = (random.vec3() + 0.01).normalize();
        let at = if i.is_multiple_of(11) {
            random.vec3() * 0.2
        } else {
            random.vec3() * 4.0
        };
        let transform = Affine3A::from_translation(at)
            * Affine3A::from_axis_angle(spin, 3.0 * random.next())
            * Affine3A::from_scale(Vec3::splat(1.2) + random.vec3());
        Caster::new(meshes[i % 2].clone(), transform)
    };
    (0..count).map(place).collect()
}

/// A mask of the faces that are not the same.
fn differing(a: &[Vec<u8>], b: &[Vec<u8>]) -> u8 {
    assert_eq!((a.len(), b.len()), (6, 6));
    (0..6)
        .filter(|&i| a[i] != b[i])
        .fold(0, |mask, i| mask | 1 << i)
}

fn begin(gpu: &Gpu, map: &mut CubeShadowMap, mask: u8) {
    gpu.run(|encoder| {
        for face in CubeFace::ALL {
            if mask & 1 << face.layer() != 0 {
                drop(map.begin_face(encoder, 0, face).unwrap());
            }
        }
    });
}

#[test]
fn every_mask_of_faces_gives_the_bits_of_a_pass_for_each() {
    let Some(gpu) = gpu() else { return };
    let mut joint = CubeShadowMap::new(&gpu.device, &descriptor(FacePasses::Multiview)).unwrap();
    let casters = clutter(&gpu, 40, 3);
    let truth = fresh(&gpu, &descriptor(FacePasses::Separate), &[LIGHT], &casters);
    let truth = faces(&gpu, &truth, 0);
    draw(&gpu, &mut joint, &[LIGHT], &casters);
    for mask in 1..64_u8 {
        // The host clears these faces, so the map draws them again, and only them.
        begin(&gpu, &mut joint, mask);
        assert_eq!(differing(&faces(&gpu, &joint, 0), &truth), mask);
        draw(&gpu, &mut joint, &[LIGHT], &casters);
        assert_eq!(joint.statistics().faces_rendered, mask.count_ones());
        assert_eq!(differing(&faces(&gpu, &joint, 0), &truth), 0, "{mask:06b}");
    }
}

#[test]
fn moving_casters_give_the_same_bits_in_every_encoding() {
    let Some(gpu) = gpu() else { return };
    let formats = [
        (DepthEncoding::MajorAxis, wgpu::TextureFormat::Depth32Float),
        (
            DepthEncoding::LinearDistance,
            wgpu::TextureFormat::Depth16Unorm,
        ),
    ];
    for (encoding, format) in formats {
        let with = |passes| CubeShadowMapDescriptor {
            encoding,
            format,
            ..descriptor(passes)
        };
        let mut casters = clutter(&gpu, 24, 5);
        let [mut joint, mut separate] = [FacePasses::Multiview, FacePasses::Separate]
            .map(|passes| CubeShadowMap::new(&gpu.device, &with(passes)).unwrap());
        let mut random = Random::new(8);
        let mut masks = std::collections::BTreeSet::new();
        for step in 0..30 {
            draw(&gpu, &mut joint, &[LIGHT], &casters);
            draw(&gpu, &mut separate, &[LIGHT], &casters);
            let drawn = CubeFace::ALL.map(|face| joint.face_statistics(0, face).unwrap().state);
            masks.insert(format!("{drawn:?}"));
            let (a, b) = (faces(&gpu, &joint, 0), faces(&gpu, &separate, 0));
            assert_eq!(differing(&a, &b), 0, "{encoding:?}, step {step}");
            casters[step * 7 % 24].world_from_object.translation +=
                glam::Vec3A::from(random.vec3());
        }
        assert!(masks.len() > 5, "{masks:?}");
        // The broken twin: one of them has a caster less.
        draw(&gpu, &mut joint, &[LIGHT], &casters[1..]);
        assert_ne!(
            differing(&faces(&gpu, &joint, 0), &faces(&gpu, &separate, 0)),
            0
        );
    }
}

#[test]
fn each_light_of_a_cube_array_has_its_own_layers() {
    let Some(gpu) = gpu() else { return };
    let cube_array = gpu.support.cube_arrays;
    let lights = [0.0, 1.0, -2.0].map(|x| PointLight::new(Vec3::new(x, 0.3, 0.1), 20.0));
    let casters = clutter(&gpu, 30, 9);
    let joint = CubeShadowMapDescriptor {
        lights: 3,
        cube_array,
        ..descriptor(FacePasses::Multiview)
    };
    let joint = fresh(&gpu, &joint, &lights, &casters);
    for (place, light) in lights.iter().enumerate() {
        let alone = fresh(&gpu, &descriptor(FacePasses::Separate), &[*light], &casters);
        let (ours, truth) = (faces(&gpu, &joint, place), faces(&gpu, &alone, 0));
        assert_eq!(differing(&ours, &truth), 0, "light {place}");
        let next = faces(&gpu, &joint, (place + 1) % 3);
        assert_ne!(differing(&next, &truth), 0, "all lights look the same");
    }
}

#[test]
fn one_pass_takes_a_draw_for_each_mesh() {
    let Some(gpu) = gpu() else { return };
    let mesh = cuboid(Vec3::splat(0.5)).mesh(&gpu.device);
    let casters = [Vec3::X, Vec3::Y, Vec3::ONE]
        .map(|at| Caster::new(mesh.clone(), Affine3A::from_translation(at * 5.0)));
    let statistics = |passes| {
        let map = fresh(&gpu, &descriptor(passes), &[LIGHT], &casters);
        let s = map.statistics();
        (s.faces_rendered, s.draws, s.triangles)
    };
    // The third touches three faces.
    assert_eq!(statistics(FacePasses::Separate), (6, 3, 12 * 5));
    assert_eq!(statistics(FacePasses::Multiview), (6, 1, 12 * 3 * 6));
    assert_eq!(
        statistics(FacePasses::Auto),
        (6, 3, 12 * 5),
        "not measured faster anywhere"
    );
}

#[test]
fn a_face_begun_before_encode_is_the_hosts_and_the_others_are_drawn() {
    let Some(gpu) = gpu() else { return };
    let casters = clutter(&gpu, 30, 4);
    let truth = fresh(&gpu, &descriptor(FacePasses::Separate), &[LIGHT], &casters);
    let mut joint = CubeShadowMap::new(&gpu.device, &descriptor(FacePasses::Multiview)).unwrap();
    let frame = CubeFrame {
        lights: &[LIGHT],
        casters: &casters,
        ..Default::default()
    };
    joint.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    begin(&gpu, &mut joint, 0b000100);
    gpu.checked(|| gpu.run(|encoder| joint.encode(encoder)));
    let ours = faces(&gpu, &joint, 0);
    assert_eq!(differing(&ours, &faces(&gpu, &truth, 0)), 0b000100);
    assert!(
        ours[2].iter().all(|&byte| byte == 0),
        "cleared and left alone"
    );
}

#[test]
fn faces_that_a_first_pass_leaves_out_are_clear() {
    let Some(gpu) = gpu() else { return };
    // Texels of an earlier texture, which the driver may hand out again as they are.
    let casters = clutter(&gpu, 40, 6);
    drop(fresh(
        &gpu,
        &descriptor(FacePasses::Separate),
        &[LIGHT],
        &casters,
    ));
    let camera = view::look_at_mat4(Vec3::X * 2.0, Vec3::new(10.0, 4.0, 0.0), Vec3::Z);
    let projection = proj::perspective_infinite_reverse(1.4, 1.0, 0.1);
    let seen = View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap();
    // Some of the faces, not all.
    let narrow = CubeShadowMapDescriptor {
        reach: Radius::Texels(1.0),
        ..descriptor(FacePasses::Multiview)
    };
    let mut joint = CubeShadowMap::new(&gpu.device, &narrow).unwrap();
    let frame = CubeFrame {
        lights: &[LIGHT],
        casters: &casters,
        view: Some(&seen),
        ..Default::default()
    };
    draw_frame(&gpu, &mut joint, &frame);
    let s = joint.statistics();
    assert!(s.faces_hidden > 0 && s.faces_rendered > 1, "{s:?}");
    let truth = fresh(&gpu, &descriptor(FacePasses::Separate), &[LIGHT], &casters);
    let (ours, truth) = (faces(&gpu, &joint, 0), faces(&gpu, &truth, 0));
    for face in CubeFace::ALL {
        let at = face.layer() as usize;
        match joint.face_statistics(0, face).unwrap().state {
            shadows::FaceState::Rendered => assert!(ours[at] == truth[at], "{face:?}"),
            _ => assert!(ours[at].iter().all(|&byte| byte == 0), "{face:?}"),
        }
    }
}

#[test]
fn a_device_without_multiview_is_refused_and_auto_does_without() {
    let (device, _) = noop();
    let error = CubeShadowMap::new(&device, &descriptor(FacePasses::Multiview)).unwrap_err();
    let both = wgpu::Features::MULTIVIEW | wgpu::Features::SELECTIVE_MULTIVIEW;
    let expected = CubeShadowMapError::Multiview {
        missing: both,
        views: 0,
    };
    assert_eq!(error, expected);
    assert!(error.to_string().contains("FacePasses::Auto"), "{error}");
    for passes in [FacePasses::Auto, FacePasses::Separate] {
        CubeShadowMap::new(&device, &descriptor(passes)).unwrap();
    }

    let limits = wgpu::Limits {
        max_multiview_view_count: 6,
        ..wgpu::Limits::defaults()
    };
    let (device, _) = noop_with(wgpu::Features::MULTIVIEW, limits.clone());
    let error = CubeShadowMap::new(&device, &descriptor(FacePasses::Multiview)).unwrap_err();
    let missing = wgpu::Features::SELECTIVE_MULTIVIEW;
    assert_eq!(error, CubeShadowMapError::Multiview { missing, views: 6 });
    let (device, _) = noop_with(both, limits);
    CubeShadowMap::new(&device, &descriptor(FacePasses::Multiview)).unwrap();
}
