//! Depth encodings and formats, and the rasteriser's bias and culling.

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, Shape, cuboid, sphere, square};
use crate::cubes::{faces, fresh};
use crate::receivers::{ask, visibility};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    Bias, Caster, CasterSides, CubeShadowMapDescriptor, DepthEncoding, Kernel, MapKind,
    MapSettings, PcfDescriptor, PointLight, glam, wgpu,
};
use wgpu::TextureFormat::{Depth16Unorm, Depth24Plus, Depth32Float};

const FORMATS: [wgpu::TextureFormat; 3] = [Depth32Float, Depth24Plus, Depth16Unorm];
const ENCODINGS: [DepthEncoding; 2] = [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance];
const RANGE: f32 = 16.0;

fn descriptor(
    format: wgpu::TextureFormat,
    encoding: DepthEncoding,
) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: 256,
        settings: MapSettings {
            format,
            ..Default::default()
        },
        encoding,
        ..Default::default()
    }
}

/// Its near plane at 1, so that depths are one over distances.
fn light() -> PointLight {
    PointLight {
        near: Some(1.0),
        ..PointLight::new(Vec3::new(0.1, -0.2, 0.3), RANGE)
    }
}

/// Small casters around the light, receivers behind and between them on a sphere.
struct Shell {
    casters: Vec<Caster>,
    points: Vec<(Vec3, Vec3)>,
    lit: Vec<f32>,
}

fn shell(gpu: &Gpu) -> Shell {
    let mut random = Random::new(4);
    let shape = cuboid(Vec3::new(0.5, 0.3, 0.4));
    let mesh = shape.mesh(&gpu.device);
    let mut truth = Triangles::default();
    let casters = (0..60)
        .map(|_| {
            let at = light().position + random.vec3().normalize() * 4.0;
            let transform = Affine3A::from_translation(at);
            truth.add(&shape.positions, &shape.indices, transform);
            Caster::new(mesh.clone(), transform)
        })
        .collect();
    let origin = light().position.as_dvec3();
    let mut points = Vec::new();
    let mut lit = Vec::new();
    while points.len() < 3000 {
        let direction = random.vec3().normalize();
        let blocked = |d: Vec3| truth.nearest(origin, d.as_dvec3()).is_some();
        // Away from the shadows' outlines: six texels around all see the same.
        let here = blocked(direction);
        let (a, b) = direction.any_orthonormal_pair();
        let alike = (0..16).all(|i| {
            let (sine, cosine) = (i as f32 * 0.39).sin_cos();
            let ring = |texels: f32| (a * cosine + b * sine) * 2.0 * texels / 256.0;
            [1.5, 3.0, 4.5, 6.0]
                .into_iter()
                .all(|texels| blocked(direction + ring(texels)) == here)
        });
        if alike {
            // Little behind the casters, where depths that are somewhat wrong change the answer.
            points.push((light().position + direction * 5.0, direction));
            lit.push(if here { 0.0 } else { 1.0 });
        }
    }
    Shell {
        casters,
        points,
        lit,
    }
}

fn wrong(seen: &[f32], truth: &[f32]) -> usize {
    seen.iter().zip(truth).filter(|(a, b)| a != b).count()
}

#[test]
fn every_encoding_in_every_format_shadows_what_rays_do() {
    let Some(gpu) = Gpu::for_test() else { return };
    let shell = shell(&gpu);
    for format in FORMATS {
        for encoding in ENCODINGS {
            let map = fresh(&gpu, &descriptor(format, encoding), light(), &shell.casters);
            let narrow = |kernel: &Kernel| !matches!(kernel, Kernel::ContactHardening(_));
            let read = Kernel::ALL
                .into_iter()
                .filter(|kernel| kernel.reads(MapKind::Cube(encoding)));
            for kernel in read.filter(narrow) {
                let seen = visibility(&gpu, &map, kernel, &shell.points);
                assert_eq!(
                    wrong(&seen, &shell.lit),
                    0,
                    "{format:?} {encoding:?} {kernel:?}"
                );
            }
            let fewer = &shell.casters[..50];
            let twin = fresh(&gpu, &descriptor(format, encoding), light(), fewer);
            let seen = visibility(&gpu, &twin, Kernel::Hard, &shell.points);
            assert!(
                wrong(&seen, &shell.lit) > 20,
                "the broken twin: casters left out"
            );
        }
    }
}

/// Points on a plane below the light, from straight on to a cosine of 0.05.
fn floor(gpu: &Gpu) -> (Caster, Vec<(Vec3, Vec3)>) {
    let turn = Affine3A::from_axis_angle(Vec3::new(0.3, 0.1, 0.9).normalize(), 0.3);
    let down = Affine3A::from_translation(light().position) * turn;
    let place = |x: f32, z: f32| down.transform_point3(Vec3::new(x, -1.5, z));
    let normal = turn.transform_vector3(Vec3::Y);
    let mut random = Random::new(6);
    let points = (0..3000)
        .map(|_| (place(random.next() * 9.0, random.next() * 9.0), normal))
        .collect();
    let caster = square(30.0).caster(
        &gpu.device,
        down * Affine3A::from_translation(Vec3::Y * -1.5),
    );
    (caster, points)
}

#[test]
fn no_encoding_in_any_format_shows_acne_on_a_flat_receiver() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (caster, points) = floor(&gpu);
    for format in FORMATS {
        for encoding in ENCODINGS {
            let with = |bias| {
                let descriptor = CubeShadowMapDescriptor {
                    settings: MapSettings {
                        format,
                        bias,
                        ..Default::default()
                    },
                    ..descriptor(format, encoding)
                };
                let map = fresh(&gpu, &descriptor, light(), std::slice::from_ref(&caster));
                visibility(&gpu, &map, Kernel::FourTaps, &points)
            };
            let dark = |seen: Vec<f32>| seen.iter().filter(|&&v| v < 1.0).count();
            assert_eq!(dark(with(Bias::default())), 0, "{format:?} {encoding:?}");
            if format == Depth32Float {
                assert!(dark(with(Bias::NONE)) > 10, "the broken twin, {encoding:?}");
            }
        }
    }
}

#[test]
fn texels_hold_what_the_encoding_says() {
    let Some(gpu) = Gpu::for_test() else { return };
    let floor = square(40.0).caster(
        &gpu.device,
        Affine3A::from_translation(light().position - Vec3::Y * 3.0),
    );
    let read = |encoding| {
        let descriptor = CubeShadowMapDescriptor {
            size: 64,
            ..descriptor(Depth32Float, encoding)
        };
        let map = fresh(&gpu, &descriptor, light(), std::slice::from_ref(&floor));
        let texels: Vec<f32> = bytemuck::pod_collect_to_vec(&faces(&gpu, &map)[3]);
        (texels, map)
    };
    let (major, _) = read(DepthEncoding::MajorAxis);
    let (linear, map) = read(DepthEncoding::LinearDistance);
    for (i, (major, linear)) in major.iter().zip(linear).enumerate() {
        let at = |i: usize| (i as f32 + 0.5) / 32.0 - 1.0;
        let slant = Vec3::new(at(i % 64), 1.0, at(i / 64)).length();
        assert!((major - 1.0 / 3.0).abs() < 1e-6, "{major}");
        assert!((linear - 3.0 * slant / RANGE).abs() < 1e-6, "{linear}");
    }
    let up: Vec<f32> = bytemuck::pod_collect_to_vec(&faces(&gpu, &map)[2]);
    assert!(up.iter().all(|&depth| depth == 1.0), "nothing stored is 1");
}

#[test]
fn the_textbook_method_is_a_preset() {
    let Some(gpu) = Gpu::for_test() else { return };
    let shell = shell(&gpu);
    let textbook = CubeShadowMapDescriptor {
        size: 256,
        ..CubeShadowMapDescriptor::textbook()
    };
    let map = fresh(&gpu, &textbook, light(), &shell.casters);
    // Six passes, each with every caster.
    assert_eq!(map.statistics().faces_rendered, 6);
    assert_eq!(map.statistics().triangles, 6 * 60 * 12);
    let reader = PcfDescriptor {
        map: MapKind::Cube(DepthEncoding::LinearDistance),
        textbook: true,
        ..Default::default()
    };
    let seen = ask(&gpu, &map, &reader, 0, &shell.points);
    assert_eq!(
        wrong(&seen, &shell.lit),
        0,
        "far behind its casters it is right"
    );
    // Its bias of 0.15 lets light in below a caster; ours does not.
    let near: Vec<_> = shell
        .casters
        .iter()
        .map(|caster| {
            let centre = Vec3::from(caster.world_from_object.translation);
            let away = (centre - light().position).normalize();
            (centre + away * 0.1, away)
        })
        .collect();
    let thin = square(0.5);
    let sheets: Vec<Caster> = near
        .iter()
        .map(|(at, away)| {
            let turn = glam::Quat::from_rotation_arc(Vec3::Y, *away);
            let transform = Affine3A::from_rotation_translation(turn, *at - *away * 0.1);
            thin.caster(&gpu.device, transform)
        })
        .collect();
    let lit = |seen: Vec<f32>| seen.iter().filter(|&&v| v > 0.5).count();
    let theirs = fresh(&gpu, &textbook, light(), &sheets[..1]);
    assert_eq!(lit(ask(&gpu, &theirs, &reader, 0, &near[..1])), 1);
    let ours = descriptor(Depth32Float, DepthEncoding::MajorAxis);
    let ours = fresh(&gpu, &ours, light(), &sheets[..1]);
    assert_eq!(lit(visibility(&gpu, &ours, Kernel::Hard, &near[..1])), 0);
}

#[test]
fn closed_meshes_may_cast_from_their_far_sides_mirrored_ones_too() {
    let Some(gpu) = Gpu::for_test() else { return };
    // In units so small that the cube of one is 0 in f32.
    const UNIT: f32 = 1e16;
    let in_small_units = |shape: Shape| {
        let scaled = |p: [f32; 3]| p.map(|x| UNIT * x);
        Shape {
            positions: shape.positions.into_iter().map(scaled).collect(),
            ..shape
        }
    };
    let mesh = in_small_units(sphere(12, 16)).mesh(&gpu.device);
    let open = in_small_units(square(1.0)).mesh(&gpu.device);
    let depth_of = |sides, mesh: &shadows::CasterMesh, mirror: f32| {
        let transform = Affine3A::from_translation(light().position + Vec3::X * 5.0)
            * Affine3A::from_rotation_z(1.2)
            * Affine3A::from_scale(Vec3::new(mirror, 1.0, 1.0) / UNIT);
        let descriptor = CubeShadowMapDescriptor {
            size: 33,
            settings: MapSettings {
                sides,
                ..Default::default()
            },
            ..Default::default()
        };
        let casters = [Caster::new(mesh.clone(), transform)];
        let map = fresh(&gpu, &descriptor, light(), &casters);
        let texels: Vec<f32> = bytemuck::pod_collect_to_vec(&faces(&gpu, &map)[0]);
        1.0 / texels[33 * 33 / 2]
    };
    for mirror in [1.0, -1.0] {
        let near = depth_of(CasterSides::Both, &mesh, mirror);
        let far = depth_of(CasterSides::Far, &mesh, mirror);
        assert!((near - 4.0).abs() < 0.1, "{near}");
        assert!((far - 6.0).abs() < 0.1, "{far}");
        // What has no inside casts from both sides all the same.
        let open = depth_of(CasterSides::Far, &open, mirror);
        assert!((open - 5.0).abs() < 0.1, "{open}");
    }
}

#[test]
fn a_slope_scaled_bias_moves_slopes_away_and_nothing_else() {
    let Some(gpu) = Gpu::for_test() else { return };
    let depth_of = |slope_scale, tilt: f32| {
        let transform = Affine3A::from_translation(light().position + Vec3::X * 5.0)
            * Affine3A::from_rotation_z(tilt);
        let caster = square(2.0).caster(&gpu.device, transform);
        let bias = Bias {
            slope_scale,
            ..Bias::default()
        };
        let descriptor = CubeShadowMapDescriptor {
            size: 33,
            settings: MapSettings {
                bias,
                ..Default::default()
            },
            ..Default::default()
        };
        let map = fresh(&gpu, &descriptor, light(), &[caster]);
        let texels: Vec<f32> = bytemuck::pod_collect_to_vec(&faces(&gpu, &map)[0]);
        1.0 / texels[33 * 33 / 2]
    };
    let upright = std::f32::consts::FRAC_PI_2;
    assert!((depth_of(4.0, upright) - depth_of(0.0, upright)).abs() < 1e-5);
    let moved = depth_of(4.0, 0.5) - depth_of(0.0, 0.5);
    assert!(moved > 0.1, "{moved}");
}

/// A map of two spheres and a box around the light, one of them mirrored.
fn nearest_sides(gpu: &Gpu, sides: CasterSides, shape: &Shape, light: PointLight) -> Vec<f32> {
    let mesh = shape.mesh(&gpu.device);
    let mut random = Random::new(31);
    let casters: Vec<Caster> = (0..30)
        .map(|i| {
            let mirror = Vec3::new(if i % 2 == 0 { -1.0 } else { 1.0 }, 0.7, 1.3);
            let transform = Affine3A::from_translation(random.vec3() * 6.0)
                * Affine3A::from_axis_angle(random.vec3().normalize(), random.next() * 3.0)
                * Affine3A::from_scale(mirror);
            Caster::new(mesh.clone(), transform)
        })
        .collect();
    let descriptor = CubeShadowMapDescriptor {
        size: 128,
        settings: MapSettings {
            sides,
            ..Default::default()
        },
        ..Default::default()
    };
    let map = fresh(gpu, &descriptor, light, &casters);
    faces(gpu, &map)
        .iter()
        .flat_map(|face| bytemuck::pod_collect_to_vec::<u8, f32>(face))
        .collect()
}

#[test]
fn the_sides_that_face_the_light_are_all_that_it_takes() {
    let Some(gpu) = Gpu::for_test() else { return };
    let flipped = |shape: Shape| Shape {
        indices: shape.indices.into_iter().rev().collect(),
        ..shape
    };
    let mut far = 0;
    for shape in [
        sphere(12, 16),
        cuboid(Vec3::splat(0.7)),
        flipped(sphere(6, 8)),
        square(0.8),
    ] {
        for light in [light(), PointLight::new(Vec3::new(2.0, 1.0, 0.5), 20.0)] {
            let [near, both, back] = [CasterSides::Nearest, CasterSides::Both, CasterSides::Far]
                .map(|sides| nearest_sides(&gpu, sides, &shape, light));
            let differ = |a: &[f32], by: f32| {
                a.iter()
                    .zip(&both)
                    .filter(|(a, b)| (*a - *b).abs() > by * b.abs())
                    .count()
            };
            let covered = |a: &[f32]| a.iter().filter(|&&depth| depth > 0.0).count();
            assert_eq!(covered(&near), covered(&both), "the same outline");
            // On outlines a far side may come out a little nearer than the near one it meets.
            let share = differ(&near, 0.0) as f64 / covered(&both) as f64;
            assert!(share < 1e-4, "{share}");
            assert_eq!(differ(&near, 1e-3), 0);
            far += differ(&back, 1e-3);
        }
    }
    assert!(far > 10_000, "the broken twin: the far sides, {far}");
}
