//! Flat maps: spot and directional lights, read with every kernel.

mod fit;
mod lights;

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, cuboid, square};
use crate::receivers::{ask_changed, visibility};
use glam::{Affine3A, DVec3, Vec3};
use host::gpu::Gpu;
use shadows::{
    AnyMap, Bias, Caster, CasterSides, DirectionalLight, FlatLight, Kernel, MapKind, MapSettings,
    PcfDescriptor, Radius, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight, VogelDisk, glam,
    wgpu,
};

fn spot(position: Vec3, direction: Vec3, half_angle: f32, scale: f32) -> FlatLight {
    let (position, range) = (position * scale, 100.0 * scale);
    FlatLight::Spot(SpotLight::new(position, direction, half_angle, range))
}

fn sun(toward_light: Vec3) -> FlatLight {
    FlatLight::Directional(DirectionalLight::new(toward_light))
}

fn drawn(gpu: &Gpu, descriptor: &ShadowMapDescriptor<'_>, frame: &ShadowFrame<'_>) -> ShadowMap {
    gpu.checked(|| {
        let mut map = ShadowMap::new(&gpu.device, descriptor).unwrap();
        map.prepare(&gpu.device, &gpu.queue, frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
        map
    })
}

fn of_size(size: u32, bias: Bias) -> ShadowMapDescriptor<'static> {
    ShadowMapDescriptor {
        size,
        settings: MapSettings {
            bias,
            ..Default::default()
        },
        ..Default::default()
    }
}

/// Toward the light, from a plane through the origin, at some angle to its normal.
fn at_angle(rotation: Affine3A, cosine: f32) -> Vec3 {
    rotation.transform_vector3(Vec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0))
}

#[test]
fn a_flat_receiver_has_no_acne_at_any_angle_size_and_scale() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut without_bias = 0;
    for (scale, turn, cosine) in [(1.0, 0.0, 1.0), (1e-3, 0.4, 0.3), (1e4, 2.3, 0.05)] {
        let rotation = Affine3A::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), turn);
        let world = Affine3A::from_scale(Vec3::splat(scale)) * rotation;
        let casters = [square(6.0).caster(&gpu.device, world)];
        let normal = rotation.transform_vector3(Vec3::Y);
        let mut random = Random::new(5);
        let points: Vec<_> = (0..2000)
            .map(|_| Vec3::new(random.next(), 0.0, random.next()) * 4.0)
            .map(|point| (world.transform_point3(point), normal))
            .collect();
        let toward = at_angle(rotation, cosine);
        for light in [sun(toward), spot(toward * 8.0, -toward, 0.6, scale)] {
            let frame = ShadowFrame::new(light, &casters);
            let shadowed = |map: &ShadowMap, kernel| {
                let lit = visibility(&gpu, map, kernel, &points);
                lit.iter().filter(|&&lit| lit < 1.0).count()
            };
            for size in [64, 512, 2048] {
                let map = drawn(&gpu, &of_size(size, Bias::default()), &frame);
                for kernel in Kernel::ALL {
                    let acne = shadowed(&map, kernel);
                    assert_eq!(acne, 0, "{scale} {cosine} {size} {kernel:?} {light:?}");
                }
            }
            let map = drawn(&gpu, &of_size(512, Bias::NONE), &frame);
            without_bias += shadowed(&map, Kernel::Bilinear);
        }
    }
    // The broken twin: without bias, rounding alone puts receivers in their own shadow.
    assert!(without_bias > 1000, "{without_bias}");
}

/// Boxes above the ground, and what is true of them.
struct Field {
    casters: Vec<Caster>,
    truth: Triangles,
}

fn field(gpu: &Gpu) -> Field {
    let mut random = Random::new(4);
    let shape = cuboid(Vec3::new(0.5, 0.3, 0.4));
    let mesh = shape.mesh(&gpu.device);
    let mut truth = Triangles::default();
    let casters = (0..12)
        .map(|_| {
            let transform =
                Affine3A::from_translation(
                    random.vec3() * Vec3::new(4.0, 0.5, 4.0) + Vec3::Y * 1.2,
                ) * Affine3A::from_axis_angle(random.vec3().normalize(), 3.0 * random.next());
            truth.add(&shape.positions, &shape.indices, transform);
            Caster::new(mesh.clone(), transform)
        })
        .collect();
    Field { casters, truth }
}

/// From a point of the ground to the light.
fn to_light(light: FlatLight, point: Vec3) -> DVec3 {
    match light {
        FlatLight::Spot(light) => (light.position - point).as_dvec3(),
        FlatLight::Directional(light) => light.toward_light.as_dvec3() * 100.0,
        _ => unreachable!("a kind that these tests do not ask for"),
    }
}

/// Points of the ground all around which rays say the same, and whether they are in shadow.
fn interior(field: &Field, light: FlatLight, reach: f32) -> Vec<(Vec3, bool)> {
    let blocked = |point: Vec3| {
        let nearest = field
            .truth
            .nearest(point.as_dvec3(), to_light(light, point));
        nearest.is_some_and(|t| t < 1.0)
    };
    let mut random = Random::new(8);
    (0..1500)
        .filter_map(|_| {
            let point = Vec3::new(random.next() * 6.0, 0.0, random.next() * 6.0);
            let truth = blocked(point);
            let alike = (0..24).all(|i| {
                let (sine, cosine) = (i as f32 * std::f32::consts::FRAC_PI_4).sin_cos();
                let radius = reach * (1 + i / 8) as f32 / 3.0;
                blocked(point + Vec3::new(cosine, 0.0, sine) * radius) == truth
            });
            alike.then_some((point, truth))
        })
        .collect()
}

fn wrong(gpu: &Gpu, map: &ShadowMap, kernel: Kernel, points: &[(Vec3, bool)]) -> usize {
    let receivers: Vec<_> = points.iter().map(|(point, _)| (*point, Vec3::Y)).collect();
    let seen = visibility(gpu, map, kernel, &receivers);
    let truth = points
        .iter()
        .map(|(_, blocked)| f32::from(u8::from(!blocked)));
    seen.iter()
        .zip(truth)
        .filter(|(seen, truth)| **seen != *truth)
        .count()
}

#[test]
fn shadows_fall_where_rays_say() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let lights = [
        sun(Vec3::new(0.4, 1.0, 0.2)),
        spot(
            Vec3::new(1.0, 9.0, 0.5),
            Vec3::new(-0.1, -1.0, 0.0),
            0.7,
            1.0,
        ),
    ];
    for light in lights {
        let frame = ShadowFrame::new(light, &field.casters);
        let map = drawn(&gpu, &of_size(2048, Bias::default()), &frame);
        for kernel in Kernel::ALL {
            let texels = match kernel.radius() {
                Radius::Texels(radius) => 1.5 + 1.8 * radius,
                _ => unreachable!("these tests ask for texels"),
            };
            // Texels are at most 12 / 2048 wide here, and as much longer as the light is oblique.
            let points = interior(&field, light, texels * 1.5 * 12.0 / 2048.0);
            assert!(points.iter().filter(|(_, blocked)| *blocked).count() > 20);
            assert_eq!(
                wrong(&gpu, &map, kernel, &points),
                0,
                "{kernel:?} {light:?}"
            );
        }
        // The broken twin: half the casters.
        let fewer = ShadowFrame::new(light, &field.casters[6..]);
        let map = drawn(&gpu, &of_size(2048, Bias::default()), &fewer);
        let points = interior(&field, light, 0.05);
        assert!(wrong(&gpu, &map, Kernel::Bilinear, &points) > 5);
    }
}

/// Every point is asked for with a border and with the test that stands in for one.
fn outside(
    gpu: &Gpu,
    map: &ShadowMap,
    kernel: Kernel,
    points: &[(Vec3, Vec3)],
    wgsl: &str,
) -> Vec<f32> {
    let descriptor = PcfDescriptor {
        kernel,
        map: MapKind::FLAT,
        ..Default::default()
    };
    let border = include_str!("../../shaders/flat_edge_border.wgsl");
    ask_changed(gpu, AnyMap::Flat(map), &descriptor, 0, points, |module| {
        module.replace(border, wgsl)
    })
}

#[test]
fn outside_the_map_and_behind_the_light_all_is_lit() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A roof over everything that the spot shines on, so that all texels at the edge hold a caster.
    let roof = square(30.0).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 4.0));
    let light = spot(Vec3::Y * 8.0, Vec3::NEG_Y, 0.5, 1.0);
    let casters = [roof];
    let frame = ShadowFrame::new(light, &casters);
    let map = drawn(&gpu, &of_size(256, Bias::default()), &frame);
    let edge = 8.0 * 0.5_f32.tan();
    let at = |x: f32, y: f32| (Vec3::new(x, y, 0.3), Vec3::Y);
    let points = [
        at(0.0, 0.0),         // under the roof
        at(edge * 1.5, 0.0),  // beside the map
        at(edge * 9.0, 0.0),  // far beside
        at(-edge * 1.5, 0.0), // beside
        at(0.0, 9.0),         // behind the light
        at(0.0, 30.0),        // far behind
        at(0.0, -200.0),      // beyond the range
    ];
    let expected = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0];
    let border = include_str!("../../shaders/flat_edge_border.wgsl");
    let test = include_str!("../../shaders/flat_edge_test.wgsl");
    for kernel in Kernel::ALL {
        for wgsl in [border, test] {
            let seen = outside(&gpu, &map, kernel, &points, wgsl);
            assert_eq!(seen, expected, "{kernel:?}");
        }
        // The broken twin: every texel taken for one inside, at the nearest place that is.
        let descriptor = PcfDescriptor {
            kernel,
            map: MapKind::FLAT,
            ..Default::default()
        };
        let clamped = ask_changed(
            &gpu,
            AnyMap::Flat(&map),
            &descriptor,
            0,
            &points,
            |module| {
                let inner = |place: &str| format!("clamp({place}, vec2f(0.01), vec2f(0.99))");
                let mut changed = module.replace(test, border);
                for place in [
                    "place * receiver.light.step + receiver.tile.middle",
                    "corner * receiver.light.step + receiver.tile.middle",
                    "centre * light.step + receiver.tile.corner",
                    "place * light.step + 0.5",
                ] {
                    changed = changed.replace(place, &inner(place));
                }
                changed
            },
        );
        assert_ne!(clamped, expected, "{kernel:?}");
    }
    // Without casters there is no map to be outside of.
    let map = drawn(
        &gpu,
        &of_size(256, Bias::default()),
        &ShadowFrame::new(sun(Vec3::Y), &[]),
    );
    assert_eq!(visibility(&gpu, &map, Kernel::Bilinear, &points), [1.0; 7]);
}

#[test]
fn coarser_formats_show_no_acne_either() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = [square(6.0).caster(&gpu.device, Affine3A::IDENTITY)];
    let mut random = Random::new(5);
    let points: Vec<_> = (0..2000)
        .map(|_| (Vec3::new(random.next(), 0.0, random.next()) * 3.0, Vec3::Y))
        .collect();
    let toward = Vec3::new(0.6, 0.8, 0.0);
    let mut broken = 0;
    for format in [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth24Plus,
        wgpu::TextureFormat::Depth16Unorm,
    ] {
        for light in [sun(toward), spot(toward * 8.0, -toward, 0.6, 1.0)] {
            let descriptor = ShadowMapDescriptor {
                settings: MapSettings {
                    format,
                    ..Default::default()
                },
                ..of_size(2048, Bias::default())
            };
            let map = drawn(&gpu, &descriptor, &ShadowFrame::new(light, &casters));
            assert_eq!(map.texture().format(), format);
            // A single texel, gathered ones, and taps of a disk.
            for kernel in [
                Kernel::Hard,
                Kernel::Weighted7,
                Kernel::Vogel(VogelDisk::default()),
            ] {
                let acne = |lit: Vec<f32>| lit.iter().filter(|&&lit| lit < 1.0).count();
                let seen = visibility(&gpu, &map, kernel, &points);
                assert_eq!(acne(seen), 0, "{format:?} {light:?} {kernel:?}");
                // The broken twin: no step of the format.
                let descriptor = PcfDescriptor {
                    kernel,
                    map: MapKind::FLAT,
                    ..Default::default()
                };
                let map = AnyMap::Flat(&map);
                broken += acne(ask_changed(&gpu, map, &descriptor, 0, &points, |module| {
                    module.replace("inverse, spot) + light.quantum", "inverse, spot)")
                }));
            }
        }
    }
    assert!(broken > 1000, "{broken}");
}

#[test]
fn casters_before_the_near_plane_still_cast() {
    let Some(gpu) = Gpu::for_test() else { return };
    if !gpu.support.depth_clip_control {
        return;
    }
    let caster =
        cuboid(Vec3::splat(0.3)).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 7.5));
    let casters = [caster];
    let light = FlatLight::Spot(SpotLight {
        position: Vec3::Y * 8.0,
        direction: Vec3::NEG_Y,
        half_angle: 0.6,
        range: 20.0,
        near: Some(4.0),
    });
    let receivers = shadows::mesh::Bounds {
        min: Vec3::new(-9.0, 0.0, -9.0),
        max: Vec3::new(9.0, 0.1, 9.0),
    };
    for light in [light, sun(Vec3::Y)] {
        let frame = ShadowFrame {
            receivers: Some(receivers),
            ..ShadowFrame::new(light, &casters)
        };
        let points = [(Vec3::ZERO, Vec3::Y), (Vec3::X * 4.0, Vec3::Y)];
        let map = drawn(&gpu, &of_size(512, Bias::default()), &frame);
        assert_eq!(visibility(&gpu, &map, Kernel::Bilinear, &points)[0], 0.0);
        let clipped = ShadowMapDescriptor {
            unclipped_depth: false,
            ..of_size(512, Bias::default())
        };
        let map = drawn(&gpu, &clipped, &frame);
        let seen = visibility(&gpu, &map, Kernel::Bilinear, &points);
        // The broken twin: clipped, the spot loses it; the sun's near plane moves before it.
        let lost = matches!(light, FlatLight::Spot(_));
        assert_eq!(seen[0], f32::from(u8::from(lost)));
    }
}

#[test]
fn what_has_not_changed_is_not_drawn_again() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let (device, queue) = (&gpu.device, &gpu.queue);
    let mut map = ShadowMap::new(device, &of_size(256, Bias::default())).unwrap();
    let light = spot(Vec3::Y * 9.0, Vec3::NEG_Y, 0.7, 1.0);
    let draws = |map: &mut ShadowMap, light, casters: &[Caster]| {
        map.prepare(device, queue, &ShadowFrame::new(light, casters))
            .unwrap();
        gpu.run(|encoder| map.encode(encoder));
        map.statistics()
    };
    let first = draws(&mut map, light, &field.casters);
    assert!(
        first.rendered && first.casters_drawn == 12 && first.draws == 1,
        "{first:?}"
    );
    assert_eq!(first.triangles, 12 * 12);
    assert!(!draws(&mut map, light, &field.casters).rendered);
    // A caster, or the light, elsewhere.
    let mut casters = field.casters.clone();
    casters[3].world_from_object.translation.x += 0.1;
    assert!(draws(&mut map, light, &casters).rendered);
    let turned = spot(Vec3::Y * 9.0, Vec3::new(0.1, -1.0, 0.0), 0.7, 1.0);
    assert!(draws(&mut map, turned, &casters).rendered);
    // Empty: cleared once.
    assert!(draws(&mut map, light, &[]).rendered);
    assert!(!draws(&mut map, light, &[]).rendered);
    // Turned away: nothing is on the map.
    let away = spot(Vec3::Y * 9.0, Vec3::Y, 0.7, 1.0);
    let outside = draws(&mut map, away, &casters);
    assert_eq!((outside.casters_drawn, outside.casters_outside), (0, 12));
    // What somebody else may have drawn is not kept for ours.
    assert!(draws(&mut map, light, &casters).rendered);
    map.invalidate();
    assert!(draws(&mut map, light, &casters).rendered);
}

#[test]
fn what_has_not_changed_is_not_uploaded() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = field(&gpu).casters;
    for light in [
        spot(Vec3::Y * 9.0, Vec3::NEG_Y, 0.7, 1.0),
        sun(Vec3::new(0.1, 1.0, 0.0)),
    ] {
        let mut map = ShadowMap::new(&gpu.device, &of_size(256, Bias::default())).unwrap();
        let mut frame = |casters: &[Caster], receivers| {
            let frame = ShadowFrame {
                receivers,
                ..ShadowFrame::new(light, casters)
            };
            map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
            gpu.run(|encoder| map.encode(encoder));
            let s = map.statistics();
            assert_eq!(s.casters_drawn + s.casters_outside, casters.len() as u32);
            (s.rendered, s.uploaded)
        };
        let around = |half: f32| {
            Some(shadows::mesh::Bounds {
                min: Vec3::splat(-half),
                max: Vec3::splat(half),
            })
        };
        let (rendered, uploaded) = frame(&casters, around(3.0));
        // A row of a matrix for each caster at least.
        assert!(rendered && uploaded > 48 * 8, "{uploaded}");
        assert_eq!(frame(&casters, around(3.0)), (false, 0), "still");
        casters.reverse();
        assert_eq!(frame(&casters, around(3.0)), (false, 0), "another order");
        // The broken twin: one that moved.
        casters[0].world_from_object.translation.y += 0.1;
        let (rendered, uploaded) = frame(&casters, around(3.0));
        assert!(rendered && uploaded > 48 * 8, "{uploaded}");
        assert_eq!(frame(&casters, around(3.0)), (false, 0));
    }
}

#[test]
fn a_caster_that_moves_beside_a_spots_cone_uploads_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = field(&gpu).casters;
    let far = Affine3A::from_translation(Vec3::X * 500.0);
    casters.push(cuboid(Vec3::ONE).caster(&gpu.device, far));
    let light = spot(Vec3::Y * 9.0, Vec3::NEG_Y, 0.7, 1.0);
    let mut map = drawn(
        &gpu,
        &of_size(256, Bias::default()),
        &ShadowFrame::new(light, &casters),
    );
    let mut moved = |index: usize| {
        casters[index].world_from_object.translation.z += 0.5;
        map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, &casters))
            .unwrap();
        gpu.run(|encoder| map.encode(encoder));
        (map.statistics().rendered, map.statistics().uploaded > 0)
    };
    assert_eq!(moved(12), (false, false));
    assert_eq!(moved(0), (true, true), "the broken twin: one on the map");
}

#[test]
fn front_faces_culled_leave_the_same_shadows_of_closed_meshes() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let light = sun(Vec3::new(0.4, 1.0, 0.2));
    let frame = ShadowFrame::new(light, &field.casters);
    let descriptor = ShadowMapDescriptor {
        settings: MapSettings {
            sides: CasterSides::Far,
            ..Default::default()
        },
        ..of_size(2048, Bias::default())
    };
    let map = drawn(&gpu, &descriptor, &frame);
    let points = interior(&field, light, 0.05);
    assert_eq!(wrong(&gpu, &map, Kernel::Bilinear, &points), 0);
    // The map does hold the other sides: farther from the light, so nowhere nearer.
    let depths = |map: &ShadowMap| -> Vec<f32> {
        let bytes = gpu.read_texture(map.texture(), 0, shadows::wgpu::TextureAspect::DepthOnly);
        bytemuck::pod_collect_to_vec(&bytes)
    };
    let descriptor = ShadowMapDescriptor {
        settings: MapSettings {
            sides: CasterSides::Both,
            ..Default::default()
        },
        ..of_size(2048, Bias::default())
    };
    let (back, both) = (depths(&map), depths(&drawn(&gpu, &descriptor, &frame)));
    assert!(back.iter().zip(&both).all(|(back, both)| back <= both));
    assert!(back != both);
}
