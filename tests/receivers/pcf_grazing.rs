//! How near to the light a tap takes a receiver's plane for, at grazing angles: no nearer than stated.

use crate::common::shapes::{Random, cuboid, square};
use crate::receivers::ask_changed;
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::{
    AnyMap, Bias, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DirectionalLight,
    FlatLight, Kernel, MapKind, MapSettings, PcfDescriptor, PointLight, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, SpotLight, glam,
};

const SIZE: u32 = 256;
/// Heights of the light above the plane y = 0, for receivers at distance 1.
const HEIGHTS: [f32; 3] = [1e-3, 1e-4, 1e-6];

/// Points of the plane y = 0 at distance 1 from the origin, up to an angle from the x axis.
fn points(angle: f32) -> Vec<(Vec3, Vec3)> {
    let mut random = Random::new(9);
    (0..600)
        .map(|_| angle * random.next())
        .map(|angle| (Vec3::new(angle.cos(), 0.0, angle.sin()), Vec3::Y))
        .collect()
}

/// How many points are lit, with the bound and with a bound that bounds nothing.
fn lit(gpu: &Gpu, map: AnyMap<'_>, kernel: Kernel, points: &[(Vec3, Vec3)]) -> [usize; 2] {
    let descriptor = PcfDescriptor {
        kernel,
        map: map.kind(),
        ..Default::default()
    };
    [false, true].map(|broken| {
        let seen = ask_changed(gpu, map, &descriptor, 0, points, |module| match broken {
            false => module,
            true => {
                let far = module
                    .replace(", receiver.bound)", ", 3e38)")
                    .replace("vec4f(receiver.bound)", "vec4f(3e38)")
                    .replace(", 32.0 * own)", ", 3e38)")
                    .replace("max(bound, 0.0)", "3e38");
                assert_ne!(far, module);
                far
            }
        });
        seen.into_iter().filter(|&lit| lit > 0.0).count()
    })
}

/// A box around a light, whose sides are so far away.
fn around(gpu: &Gpu, light: Vec3, half: f32) -> [Caster; 1] {
    [cuboid(Vec3::splat(half)).caster(&gpu.device, Affine3A::from_translation(light))]
}

fn cube(gpu: &Gpu, light: Vec3, casters: &[Caster]) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size: SIZE,
        settings: MapSettings {
            bias: Bias::NONE,
            ..Default::default()
        },
        ..Default::default()
    };
    let mut map = CubeShadowMap::new(&gpu.device, &descriptor).unwrap();
    let frame = CubeFrame::new(PointLight::new(light, 10.0), casters);
    map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn flat(gpu: &Gpu, frame: &ShadowFrame<'_>) -> ShadowMap {
    let descriptor = ShadowMapDescriptor {
        size: SIZE,
        settings: MapSettings {
            bias: Bias::NONE,
            ..Default::default()
        },
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    map.prepare(&gpu.device, &gpu.queue, frame).unwrap();
    gpu.run(|encoder| map.encode(encoder));
    map
}

fn spot(gpu: &Gpu, light: Vec3, casters: &[Caster]) -> ShadowMap {
    let light = FlatLight::Spot(SpotLight::new(light, Vec3::X, 0.7, 10.0));
    flat(gpu, &ShadowFrame::new(light, casters))
}

#[test]
fn what_is_nearer_than_a_thirty_second_of_the_distance_casts_at_any_angle() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (all_round, before) = (points(3.0), points(0.3));
    let (mut unbounded, mut farther) = ([0; 2], [0; 2]);
    for height in HEIGHTS {
        let light = Vec3::Y * height;
        // The receivers' distance along an axis is at least 0.7: a thirty-second of that is 0.022.
        let near = around(&gpu, light, 0.02);
        let (cube_near, spot_near) = (cube(&gpu, light, &near), spot(&gpu, light, &near));
        let far = around(&gpu, light, 0.1);
        let (cube_far, spot_far) = (cube(&gpu, light, &far), spot(&gpu, light, &far));
        for kernel in Kernel::ALL {
            for (kind, near, far, points) in [
                (
                    0,
                    AnyMap::from(&cube_near),
                    AnyMap::from(&cube_far),
                    &all_round,
                ),
                (
                    1,
                    AnyMap::from(&spot_near),
                    AnyMap::from(&spot_far),
                    &before,
                ),
            ] {
                let [bounded, broken] = lit(&gpu, near, kernel, points);
                assert_eq!(bounded, 0, "{kernel:?}, {height}, map {kind}");
                unbounded[kind] += broken;
                farther[kind] += lit(&gpu, far, kernel, points)[0];
            }
        }
    }
    println!("lit without the bound: {unbounded:?}, beyond it: {farther:?}");
    // The broken twin, and what the bound does not promise: a caster farther away.
    assert!(unbounded.iter().all(|&lit| lit > 100), "{unbounded:?}");
    assert!(farther.iter().all(|&lit| lit > 100), "{farther:?}");
}

#[test]
fn what_is_sixteen_widths_before_a_receiver_casts_under_a_directional_light_of_any_angle() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A wall, 80 before the receivers; the map is about 2.4 wide.
    let wall = Affine3A::from_translation(Vec3::X * 80.0)
        * Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let casters = [square(30.0).caster(&gpu.device, wall)];
    let mut random = Random::new(2);
    let points: Vec<_> = (0..600)
        .map(|_| (Vec3::new(random.next(), 0.0, random.next()), Vec3::Y))
        .collect();
    let mut unbounded = 0;
    for height in HEIGHTS {
        let light = FlatLight::Directional(DirectionalLight::new(Vec3::new(1.0, height, 0.0)));
        let frame = ShadowFrame {
            receivers: Some(shadows::mesh::Bounds {
                min: Vec3::new(-1.0, 0.0, -1.0),
                max: Vec3::new(1.0, 0.1, 1.0),
            }),
            ..ShadowFrame::new(light, &casters)
        };
        let map = flat(&gpu, &frame);
        for kernel in Kernel::ALL {
            let [bounded, broken] = lit(&gpu, AnyMap::from(&map), kernel, &points);
            assert_eq!(bounded, 0, "{kernel:?}, {height}");
            unbounded += broken;
        }
    }
    println!("lit without the bound: {unbounded}");
    assert!(unbounded > 100, "{unbounded}");
}

#[test]
fn far_below_all_casters_of_a_directional_light_only_their_shadow_is_dark() {
    let Some(gpu) = Gpu::for_test() else { return };
    // A box half a unit wide, up to thousands of widths of its map above the ground.
    let points = [
        (Vec3::ZERO, Vec3::Y),
        (Vec3::X * 0.4, Vec3::Y),
        (Vec3::X * 9.0, Vec3::Y),
    ];
    let expected = [0.0, 1.0, 1.0];
    let light = FlatLight::Directional(DirectionalLight::new(Vec3::Y));
    let mut below_zero = 0;
    for height in [1.0, 40.0, 5000.0] {
        let place = Affine3A::from_translation(Vec3::Y * height);
        let casters = [cuboid(Vec3::splat(0.25)).caster(&gpu.device, place)];
        let map = flat(&gpu, &ShadowFrame::new(light, &casters));
        for kernel in Kernel::ALL {
            let descriptor = PcfDescriptor {
                kernel,
                map: AnyMap::from(&map).kind(),
                ..Default::default()
            };
            let asked = |change: fn(String) -> String| {
                ask_changed(&gpu, AnyMap::from(&map), &descriptor, 0, &points, change)
            };
            assert_eq!(asked(|module| module), expected, "{kernel:?}, {height}");
            // The broken twin: a bound below the depth of an empty texel.
            let broken = asked(|module| {
                let nearest = module.replace("nearest = max(0.0, ", "nearest = (");
                nearest.replace("max(depths, vec4f(0.0)) <", "depths <")
            });
            below_zero += usize::from(broken != expected);
        }
    }
    assert!(below_zero > 9, "{below_zero}");
}

/// Light over a tilted plane whose horizon crosses texels, and what moves an upright scene there.
const LOW: Vec3 = Vec3::new(0.0, 0.02, 0.0);

fn tilted() -> Affine3A {
    let tilt = Affine3A::from_rotation_x(0.4);
    Affine3A::from_translation(LOW) * tilt * Affine3A::from_translation(-LOW)
}

/// Points of that plane from 1 to 8 away from the light, up to an angle from the x axis.
fn tilted_points(angle: f32) -> Vec<(Vec3, Vec3)> {
    let place = tilted();
    let distances = (0..600).map(|i| 1.0 + 7.0 * (i as f32 / 600.0));
    let points = points(angle).into_iter().zip(distances);
    points
        .map(|((at, up), distance)| (at * distance, up))
        .map(|(at, up)| (place.transform_point3(at), place.transform_vector3(up)))
        .collect()
}

/// How many of those points are as they should not be, right and with the module changed, by kernel
/// and map.
fn wrong_beyond(
    gpu: &Gpu,
    casters: &[Caster],
    wrong: fn(f32) -> bool,
    change: fn(String) -> String,
) -> Vec<(Kernel, [usize; 2])> {
    let (cube, spot) = (cube(gpu, LOW, casters), spot(gpu, LOW, casters));
    let (all_round, before) = (tilted_points(3.0), tilted_points(0.3));
    let maps = [
        (AnyMap::from(&cube), &all_round),
        (AnyMap::from(&spot), &before),
    ];
    let count = |map: AnyMap<'_>, points: &[_], kernel, change: fn(String) -> String| {
        let descriptor = PcfDescriptor {
            kernel,
            map: map.kind(),
            ..Default::default()
        };
        let seen = ask_changed(gpu, map, &descriptor, 0, points, change);
        seen.into_iter().filter(|&lit| wrong(lit)).count()
    };
    let mut counts = Vec::new();
    for (map, points) in maps {
        for kernel in Kernel::ALL {
            let both = [|module| module, change].map(|change| count(map, points, kernel, change));
            println!("{:?} {kernel:?}: {both:?}", map.kind());
            counts.push((kernel, both));
        }
    }
    counts
}

#[test]
fn what_stands_beyond_the_horizon_of_a_receiver_casts_no_shadow_on_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Walls far behind the receivers, which texels above the plane's horizon look at.
    let walls = around(&gpu, LOW, 2000.0);
    let dark = |lit| lit < 1.0;
    // The broken twin: such texels taken to see the plane, infinitely far away.
    let counts = wrong_beyond(&gpu, &walls, dark, |module| {
        module
            .replace("select(texel, mirrored, behind)", "texel")
            .replace(
                "texel = shadows_flat_floor(receiver, 2.0 * receiver.texel - texel - 0.5);",
                "",
            )
            .replace("select(receiver.own, ", "select(0.0, ")
            .replace(", receiver.own, ", ", 0.0, ")
            .replace(", receiver.alone, ", ", 0.0, ")
    });
    for (kernel, [right, broken]) in counts {
        // No texel by itself has a depth there that could be broken.
        let breaks = kernel != Kernel::HardwareBilinear;
        assert!(
            right == 0 && (broken > 4 || !breaks),
            "{kernel:?}: {right} {broken}"
        );
    }
}

#[test]
fn texels_beyond_the_horizon_are_reflected_into_the_shadow_of_what_ends_there() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Four walls around the light, up to the horizon: all beyond them is in shadow, and texels above
    // the horizon are empty.
    let wall = Affine3A::from_translation(Vec3::new(0.5, LOW.y - 0.5, 0.0))
        * Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let walls = [0.0, 0.5, 1.0, 1.5].map(|turn| {
        let turn = Affine3A::from_rotation_y(turn * std::f32::consts::PI);
        square(0.5).caster(&gpu.device, tilted() * turn * wall)
    });
    // Within half a texel of the horizon the reflection of a texel may be beyond it as well.
    let lit = |lit| lit > 0.15;
    // The broken twin: no reflection.
    let counts = wrong_beyond(&gpu, &walls, lit, |module| {
        module
            .replace("select(texel, mirrored, behind)", "texel")
            .replace(
                "texel = shadows_flat_floor(receiver, 2.0 * receiver.texel - texel - 0.5);",
                "",
            )
    });
    for (kernel, [right, broken]) in counts {
        match kernel.uses_pixel() {
            // Nor is anything here: texels above the horizon are empty.
            _ if kernel == Kernel::HardwareBilinear => assert!(right < 120, "{right}"),
            false => assert!(right == 0 && broken > 4, "{kernel:?}: {right} {broken}"),
            // The taps of a disk are on the plane, and nothing is to be reflected.
            true => assert!(right < 30 && broken == right, "{kernel:?}: {right}"),
        }
    }
}

/// Rows of the map are so wide there that the one that a receiver lies in has its centre above the horizon
/// of the ground.
#[test]
fn a_disk_by_a_row_above_the_ground_is_compared_with_the_receivers_own_distance() {
    let Some(gpu) = Gpu::for_test() else { return };
    let light = Vec3::Y * 8e-3;
    // A wall at x = 9, and the ground behind it.
    let wall = Affine3A::from_translation(Vec3::X * 9.0)
        * Affine3A::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let casters = [square(8.0).caster(&gpu.device, wall)];
    let mut random = Random::new(4);
    let points: Vec<_> = (0..600)
        .map(|_| Vec3::new(13.0 + 3.0 * random.next(), 0.0, 2.0 * random.next()))
        .map(|point| (point, Vec3::Y))
        .collect();
    // The horizon is 0.45 of a row above the axis, the ground behind the wall 0.2 to 0.3.
    let tilt = 0.45 * 2.0 * 0.35f32.tan() / SIZE as f32;
    let axis = Vec3::new(1.0, -tilt, 0.0);
    let descriptor = ShadowMapDescriptor {
        size: SIZE,
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    let spot = FlatLight::Spot(SpotLight::new(light, axis, 0.35, 40.0));
    map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(spot, &casters))
        .unwrap();
    gpu.run(|encoder| map.encode(encoder));
    let disks = [
        Kernel::RandomDisk(Default::default()),
        Kernel::Vogel(Default::default()),
        Kernel::ContactHardening(Default::default()),
    ];
    for kernel in disks {
        let descriptor = PcfDescriptor {
            kernel,
            map: MapKind::FLAT,
            ..Default::default()
        };
        let lit = |own: &str| {
            let seen = ask_changed(&gpu, (&map).into(), &descriptor, 0, &points, |module| {
                let asked = "select(depth, receiver.alone, beyond)";
                assert!(module.contains(asked));
                module.replace(asked, own)
            });
            seen.into_iter().filter(|&lit| lit > 0.0).count()
        };
        assert_eq!(
            lit("select(depth, receiver.alone, beyond)"),
            0,
            "{kernel:?}"
        );
        // The broken twin: the plane's depth there, which the bias takes for much nearer.
        let biased = lit("select(depth, receiver.own, beyond)");
        assert!(biased > 300, "{kernel:?}: {biased}");
    }
}
