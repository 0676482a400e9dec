//! What receivers see: no acne, no gap at a contact, no seam, whatever the size and scale.

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, cuboid, square};
use crate::receivers::{ask_changed, visibility};
use glam::{Affine3A, DVec3, Vec3};
use host::gpu::Gpu;
use shadows::{
    Bias, Caster, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, Kernel, MapKind,
    MapSettings, PcfDescriptor, PointLight, Radius, glam, wgpu::TextureFormat,
};

fn map(gpu: &Gpu, size: u32, bias: Bias, light: &PointLight, casters: &[Caster]) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size,
        settings: MapSettings {
            bias,
            ..Default::default()
        },
        ..Default::default()
    };
    crate::cubes::fresh(gpu, &descriptor, *light, casters)
}

/// Points of a plane through the origin that casts its own shadow map, seen at cosines from 1 down
/// to 0.01 within the light's range, the plane turned against the faces of the cube.
struct Plane {
    light: PointLight,
    caster: Caster,
    points: Vec<(Vec3, Vec3)>,
}

/// `depths`: the range as a multiple of the near distance. The light is at 1 from the plane.
fn plane(gpu: &Gpu, scale: f32, turn: f32, depths: f32) -> Plane {
    let range = (0.5 * depths).min(200.0);

    let rotation = Affine3A::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), turn);
    let world = Affine3A::from_scale(Vec3::splat(scale)) * rotation;
    let normal = rotation.transform_vector3(Vec3::Y);
    let mut random = Random::new(11);
    let points = (0..4000)
        .map(|_| {
            // Cosine 1 / sqrt(1 + r^2) from 1 down to 0.01, evenly in its logarithm.
            let cosine = 10.0_f32.powf(-1.0 - random.next());
            let radius = (1.0 / (cosine * cosine) - 1.0).max(0.0).sqrt();
            let (sine, cosine) = (random.next() * 3.15).sin_cos();
            Vec3::new(radius * cosine, 0.0, radius * sine)
        })
        .filter(|point| point.distance(Vec3::Y) < 0.99 * range)
        .map(|point| (world.transform_point3(point), normal))
        .collect();
    Plane {
        light: PointLight {
            near: Some(range / depths * scale),
            ..PointLight::new(world.transform_point3(Vec3::Y), range * scale)
        },
        caster: square(150.0).caster(&gpu.device, world),
        points,
    }
}

fn plane_map(gpu: &Gpu, plane: &Plane, size: u32, bias: Bias) -> CubeShadowMap {
    let casters = [plane.caster.clone()];
    map(gpu, size, bias, &plane.light, &casters)
}

fn shadowed(gpu: &Gpu, plane: &Plane, map: &CubeShadowMap, kernel: Kernel) -> usize {
    visibility(gpu, map, kernel, &plane.points)
        .iter()
        .filter(|&&v| v < 1.0)
        .count()
}

#[test]
fn a_flat_receiver_has_no_acne_at_any_angle_size_and_scale() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut without_bias = 0;
    for (scale, turn, depths) in [
        (1.0, 0.0, 1e5),
        (1.0, 0.4, 1e5),
        (1e-4, 1.1, 1e5),
        (1e5, 2.3, 1e5),
        (1.0, 0.9, 10.0),
        (1e5, 1.7, 1e3),
    ] {
        let plane = plane(&gpu, scale, turn, depths);
        for size in [64, 256, 1024, 4096] {
            let map = plane_map(&gpu, &plane, size, Bias::default());
            for kernel in Kernel::ALL {
                let acne = shadowed(&gpu, &plane, &map, kernel);
                assert_eq!(
                    acne, 0,
                    "scale {scale}, turn {turn}, 1:{depths}, size {size}, {kernel:?}"
                );
            }
            let map = plane_map(&gpu, &plane, size, Bias::NONE);
            without_bias += shadowed(&gpu, &plane, &map, Kernel::Bilinear);
        }
    }
    // The broken twin: without bias, rounding alone puts receivers in their own shadow.
    assert!(without_bias > 1000, "{without_bias}");
}

/// Depths that a format can tell apart: with fewer than some hundreds of steps between a receiver
/// and infinity nothing casts, and there is nothing to test.
fn sweep() -> impl Iterator<Item = (TextureFormat, DepthEncoding, f32)> {
    use DepthEncoding::{LinearDistance, MajorAxis};
    use TextureFormat::{Depth16Unorm, Depth24Plus, Depth32Float};
    let depths = [10.0, 1e3, 1e5];
    let of = move |format, encoding, count: usize| {
        let depths = depths.into_iter().take(count);
        depths.map(move |depths| (format, encoding, depths))
    };
    of(Depth32Float, LinearDistance, 3)
        .chain(of(Depth24Plus, LinearDistance, 3))
        .chain(of(Depth24Plus, MajorAxis, 3))
        .chain(of(Depth16Unorm, LinearDistance, 3))
        .chain(of(Depth16Unorm, MajorAxis, 1))
}

#[test]
fn no_acne_in_any_format_however_far_the_light_reaches() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (mut without_bias, mut without_step) = (0, 0);
    for (i, (format, encoding, depths)) in sweep().enumerate() {
        let plane = plane(&gpu, [1.0, 1e-4, 1e5][i % 3], 0.3 + i as f32, depths);
        for size in [64, 1024] {
            let dark = |bias, kernel, change: fn(String) -> String| {
                let descriptor = CubeShadowMapDescriptor {
                    size,
                    settings: MapSettings {
                        bias,
                        format,
                        ..Default::default()
                    },
                    encoding,
                    ..Default::default()
                };
                let casters = std::slice::from_ref(&plane.caster);
                let map = crate::cubes::fresh(&gpu, &descriptor, plane.light, casters);
                let reader = PcfDescriptor {
                    kernel,
                    map: MapKind::Cube(encoding),
                    ..Default::default()
                };
                let seen = ask_changed(&gpu, (&map).into(), &reader, 0, &plane.points, change);
                seen.iter().filter(|&&v| v < 1.0).count()
            };
            for kernel in [Kernel::Hard, Kernel::Bilinear, Kernel::Weighted7] {
                let acne = dark(Bias::default(), kernel, |module| module);
                assert_eq!(
                    acne, 0,
                    "{format:?} {encoding:?} 1:{depths}, size {size}, {kernel:?}"
                );
            }
            // The broken twins: no bias, and the format's own step left out.
            without_bias += dark(Bias::NONE, Kernel::Bilinear, |module| module);
            if format == TextureFormat::Depth16Unorm {
                without_step += dark(Bias::default(), Kernel::Bilinear, |module| {
                    module
                        .replace("stored + receiver.light.quantum", "stored")
                        .replace("shadows_cube_step(light.quantum)", "0.0")
                });
            }
        }
    }
    assert!(without_bias > 1000, "{without_bias}");
    assert!(without_step > 1000, "{without_step}");
}

#[test]
fn a_wall_on_the_floor_lets_no_light_in_at_the_contact() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = PointLight::new(Vec3::new(-3.0, 2.0, 0.1), 30.0);
    let floor = square(10.0).caster(&gpu.device, Affine3A::IDENTITY);
    // A wall without any thickness, in the plane x = 0.5.
    let upright = Affine3A::from_translation(Vec3::new(0.5, 0.5, 0.0))
        * Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let casters = [floor, square(0.5).caster(&gpu.device, upright)];
    for size in [256, 1024, 4096] {
        // From two texels behind the wall to where its shadow is sure to go on.
        let texel = 2.0 / size as f32 * 3.5;
        let points: Vec<_> = (0..400)
            .map(|i| {
                let t = i as f32 / 400.0;
                let x = 0.5 + 2.0 * texel + 0.3 * t * t;
                (Vec3::new(x, 0.0, 0.6 * (t * 97.0).fract() - 0.3), Vec3::Y)
            })
            .collect();
        for kernel in Kernel::ALL {
            let map = map(&gpu, size, Bias::default(), &light, &casters);
            let lit = visibility(&gpu, &map, kernel, &points);
            let gap = points.iter().zip(&lit).filter(|(_, v)| **v >= 0.5);
            let gap = gap
                .map(|((p, _), _)| (p.x - 0.5) / texel)
                .fold(0.0, f32::max);
            // The floor that a texel covers is 1.75 wide here: tests/receivers/pcf_hardware.rs.
            let promised = match kernel {
                Kernel::HardwareBilinear => 1.2 * 1.75,
                _ => 0.0,
            };
            assert!(
                gap <= promised,
                "texels of light behind the wall: {gap}, {size} {kernel:?}"
            );
        }
        // The broken twin: an absolute bias as textbooks have it, 0.15 at a distance of 3.5.
        let bias = Bias {
            constant: 0.15 / texel,
            ..Bias::NONE
        };
        let map = map(&gpu, size, bias, &light, &casters);
        let lit = visibility(&gpu, &map, Kernel::Bilinear, &points);
        assert!(lit.iter().any(|&v| v > 0.5));
    }
}

/// Receivers on a sphere around the light, some behind small casters.
struct Shell {
    light: PointLight,
    casters: Vec<Caster>,
    /// Each caster's centre relative to the light, and its triangles.
    truth: Vec<(DVec3, Triangles)>,
}

const SHELL: f32 = 10.0;

fn shell(gpu: &Gpu, seed: u64) -> Shell {
    let mut random = Random::new(seed);
    let light = PointLight::new(random.vec3(), 30.0);
    let shape = cuboid(Vec3::new(1.0, 0.6, 0.8));
    let mesh = shape.mesh(&gpu.device);
    let mut truth = Vec::new();
    let casters = (0..120)
        .map(|_| {
            let direction = random.vec3().normalize();
            let transform = Affine3A::from_translation(light.position + direction * 5.0)
                * Affine3A::from_axis_angle(random.vec3().normalize(), 3.0 * random.next());
            let mut triangles = Triangles::default();
            triangles.add(&shape.positions, &shape.indices, transform);
            truth.push(((direction * 5.0).as_dvec3(), triangles));
            Caster::new(mesh.clone(), transform)
        })
        .collect();
    Shell {
        light,
        casters,
        truth,
    }
}

/// How many texels a kernel reaches, wherever on the cube.
fn texels(kernel: Kernel) -> f32 {
    match kernel.radius() {
        Radius::Texels(radius) if kernel.uses_pixel() => radius * 3.0_f32.sqrt() + 0.5,
        Radius::Texels(radius) => radius,
        _ => unreachable!("these tests ask for texels"),
    }
}

/// Wrong and asked-for points among those on the shell whose surroundings all see the same.
fn errors(
    gpu: &Gpu,
    shell: &Shell,
    map: &CubeShadowMap,
    kernel: Kernel,
    directions: &[Vec3],
) -> (usize, usize) {
    let origin = shell.light.position.as_dvec3();
    let blocked = |direction: DVec3| {
        // The casters' half diagonal is below 1.42.
        let passes = |centre: &DVec3| {
            let along = centre.dot(direction) / direction.length();
            along > 0.0 && centre.length_squared() - along * along < 1.42 * 1.42
        };
        let mut near = shell.truth.iter().filter(|(centre, _)| passes(centre));
        near.any(|(_, triangles)| triangles.nearest(origin, direction).is_some())
    };
    // The same answer within 1.5 texels and the kernel's radius: an interior point.
    let reach = f64::from(1.5 + texels(kernel)) * 2.0 / f64::from(map.size());
    let interior: Vec<(Vec3, bool)> = directions
        .iter()
        .filter_map(|&direction| {
            let d = direction.as_dvec3() / f64::from(direction.abs().max_element());
            let truth = blocked(d);
            let (a, b) = d.normalize().any_orthonormal_pair();
            let alike = (0..48).all(|i| {
                let (sine, cosine) = (f64::from(i) * std::f64::consts::FRAC_PI_8).sin_cos();
                let radius = reach * f64::from(1 + i / 16) / 3.0 * 3.0_f64.sqrt();
                blocked(d + radius * (a * cosine + b * sine)) == truth
            });
            alike.then_some((direction, truth))
        })
        .collect();
    let points: Vec<(Vec3, Vec3)> = interior
        .iter()
        .map(|(direction, _)| (shell.light.position + *direction * SHELL, *direction))
        .collect();
    let seen = visibility(gpu, map, kernel, &points);
    let wrong = interior
        .iter()
        .zip(seen)
        .filter(|((_, blocked), seen)| *seen != if *blocked { 0.0 } else { 1.0 })
        .count();
    (wrong, interior.len())
}

/// Directions around all 12 edges and 8 corners of the cube, within some texels.
fn near_seams(size: u32) -> Vec<Vec3> {
    let mut random = Random::new(3);
    let width = 8.0 / size as f32;
    (0..6000)
        .map(|i| {
            let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            let off = 1.0 + width * random.next();
            let along = if i & 64 == 0 {
                random.next()
            } else {
                sign(4) * (1.0 + width * random.next())
            };
            let edge = Vec3::new(sign(1), sign(2) * off, along);
            match i % 3 {
                0 => edge,
                1 => Vec3::new(edge.z, edge.x, edge.y),
                _ => Vec3::new(edge.y, edge.z, edge.x),
            }
            .normalize()
        })
        .collect()
}

#[test]
fn edges_and_corners_of_the_cube_show_no_seam() {
    let Some(gpu) = Gpu::for_test() else { return };
    let size = 512;
    for seed in [1, 2] {
        let shell = shell(&gpu, seed);
        let map = map(&gpu, size, Bias::default(), &shell.light, &shell.casters);
        for kernel in Kernel::ALL {
            let (wrong, asked) = errors(&gpu, &shell, &map, kernel, &near_seams(size));
            assert!(asked > 3000, "{asked}");
            assert_eq!(wrong, 0, "{kernel:?}, seed {seed}, of {asked}");
        }
        // The broken twin: the same map asked for a light that is a little elsewhere.
        let moved = Shell {
            light: PointLight {
                position: shell.light.position + Vec3::splat(0.1),
                ..shell.light
            },
            ..shell
        };
        let (wrong, _) = errors(&gpu, &moved, &map, Kernel::Bilinear, &near_seams(size));
        assert!(wrong > 10, "{wrong}");
    }
}

#[test]
fn beyond_the_range_nothing_is_lit() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = PointLight::new(Vec3::ZERO, 10.0);
    let map = map(&gpu, 64, Bias::default(), &light, &[]);
    let at = |distance: f32| (Vec3::X * distance, Vec3::X);
    let points = [
        at(10.0_f32.next_down()),
        at(10.0),
        at(10.0_f32.next_up()),
        at(1e30),
        at(0.0),
    ];
    for kernel in Kernel::ALL {
        let seen = visibility(&gpu, &map, kernel, &points);
        assert_eq!(seen, [1.0, 1.0, 0.0, 0.0, 1.0], "{kernel:?}");
    }
}
