//! Every kernel against the same kernel with exact visibility: rays in f64 in the place of the map.

use crate::common::shapes;
use crate::exact_kernels::{SQUARES, TEXEL, mean, square, vogel};
use crate::receivers::{ask_changed, ask_group};
use crate::yard::{LIGHT, Yard, error};
use glam::{Affine3A, DVec2, DVec3, Vec3};
use host::gpu::Gpu;
use shadows::{
    AnyMap, ContactHardening, DirectionalLight, FlatLight, Kernel, MapKind, MapSettings,
    PcfDescriptor, PcfSampler, Radius, RandomDisk, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    VogelDisk, glam,
};

#[test]
fn squares_of_texels_say_what_they_say_with_exact_texels() {
    let Some(yard) = Yard::new() else { return };
    let (cube, flat) = (yard.cube(), yard.flat());
    for kernel in SQUARES {
        let exact = yard.exact(|yard, _, point| square(yard, kernel, 0.0, point));
        let shifted = yard.exact(|yard, _, point| square(yard, kernel, 1.0, point));
        for (name, seen) in [
            ("cube", yard.seen(&cube, kernel)),
            ("flat", yard.seen(&flat, kernel)),
        ] {
            let (rms, largest) = error(&seen, &exact);
            println!("{name} {kernel:?}: rms {rms:.5}, largest {largest:.3}");
            // The rasteriser snaps vertices to 1/256 of a texel: some texel in a hundred along an
            // edge may fall on its other side.
            assert!(rms < 0.02, "{name} {kernel:?}: {rms}");
            // The broken twin: one texel beside.
            let (twin, _) = error(&seen, &shifted);
            assert!(twin > 0.04 && twin > 4.0 * rms, "{name} {kernel:?}: {twin}");
        }
    }
}

#[test]
fn a_vogel_disk_says_what_it_says_with_exact_taps() {
    let Some(yard) = Yard::new() else { return };
    for (taps, radius) in [(4, 3.0), (16, 8.0), (64, 24.0)] {
        let radius_on_ground = radius * TEXEL;
        let [texels, world_units] = [
            Radius::Texels(radius as f32),
            Radius::World(radius_on_ground as f32),
        ];
        let maps = |reach| (yard.cube_of(reach), yard.flat_of(reach));
        let ((cube, flat), (world_cube, world_flat)) = (maps(texels), maps(world_units));
        // The disk's axes on the ground: first -z, then -x; in the spot's frame first +z, then -x.
        let world = DVec2::new(-1.0, -1.0);
        let framed = DVec2::new(-1.0, 1.0);
        for (map, axes, radius) in [
            (AnyMap::from(&cube), world, texels),
            (AnyMap::from(&world_cube), world, world_units),
            (AnyMap::from(&flat), framed, texels),
            (AnyMap::from(&world_flat), framed, world_units),
        ] {
            let disk = |i, point| vogel(&yard, i, point, taps, radius_on_ground * axes);
            let exact = yard.exact(|_, i, point| disk(i, point));
            let unturned = yard.exact(|_, _, point| disk(0, point));
            let seen = yard.seen(map, Kernel::Vogel(VogelDisk { radius, taps }));
            let (rms, largest) = error(&seen, &exact);
            let (noise, _) = error(&exact, &unturned);
            println!(
                "vogel {taps} {radius:?}: rms {rms:.4}, largest {largest:.3}, noise {noise:.4}"
            );
            // A tap falls on the centre of a texel: where that is on the other side of an edge the
            // tap is wrong, one of `taps`.
            assert!(rms < 0.25 / f64::from(taps).sqrt(), "{taps}: {rms}");
            // The broken twin: another pattern.
            assert!(error(&seen, &unturned).0 > 1.2 * rms);
        }
    }
}

#[test]
fn frames_average_the_noise_away() {
    let Some(mut yard) = Yard::new() else { return };
    yard.points.truncate(1000);
    let cube = yard.cube();
    let exact = yard.exact(|yard, _, point| mean(|at| yard.lit(point + at * 8.0 * TEXEL)));
    let points: Vec<_> = yard.points.iter().map(|point| (*point, Vec3::Y)).collect();
    let descriptor = PcfDescriptor {
        kernel: Kernel::Vogel(VogelDisk {
            radius: Radius::Texels(8.0),
            taps: 4,
        }),
        ..Default::default()
    };
    let sampler = PcfSampler::new(&yard.gpu.device, &yard.gpu.queue, &descriptor).unwrap();
    let group = sampler.bind_group(&yard.gpu.device, &cube).unwrap();
    let average = |frames: [u32; 16]| {
        let mut sum = vec![0.0; points.len()];
        for frame in frames {
            sampler.set_frame(&yard.gpu.queue, frame);
            let seen = ask_group(
                &yard.gpu,
                (&sampler, &group),
                &descriptor,
                0,
                &points,
                |m| m,
            );
            for (sum, seen) in sum.iter_mut().zip(seen) {
                *sum += f64::from(seen) / 16.0;
            }
        }
        error(&sum, &exact).0
    };
    let moving = average(std::array::from_fn(|frame| frame as u32));
    // The broken twin: the same frame every time; and after 64 frames it is the same.
    let still = average([0; 16]);
    println!("noise of 16 frames {moving:.4}, of one {still:.4}");
    assert!(moving < 0.5 * still, "{moving} {still}");
    assert_eq!(still, average([64; 16]));
}

#[test]
fn a_random_disk_scatters_around_the_mean_of_its_disk() {
    let Some(mut yard) = Yard::new() else { return };
    yard.points.truncate(1500);
    let cube = yard.cube();
    let radius = Radius::Texels(8.0);
    let exact = yard.exact(|yard, _, point| mean(|at| yard.lit(point + at * 8.0 * TEXEL)));
    let narrow = yard.exact(|yard, _, point| mean(|at| yard.lit(point + at * TEXEL)));
    for (around, rings) in [(8, 2), (8, 8)] {
        let disk = |early_out| {
            Kernel::RandomDisk(RandomDisk {
                radius,
                around,
                rings,
                early_out,
                ..Default::default()
            })
        };
        let (full, early) = (yard.seen(&cube, disk(false)), yard.seen(&cube, disk(true)));
        let (noise, _) = error(&full, &exact);
        let (with_early_out, _) = error(&early, &exact);
        let wrong = full
            .iter()
            .zip(&early)
            .filter(|(full, early)| full != early)
            .count();
        let worst = full
            .iter()
            .zip(&early)
            .map(|(full, early)| (full - early).abs());
        println!(
            "random disk {around} x {rings}: noise {noise:.4}, with early-out {with_early_out:.4}; \
             early-out differs at {wrong} of {} points, by at most {:.3}",
            full.len(),
            worst.fold(0.0, f64::max),
        );
        // Independent samples would scatter by 0.5 / sqrt(taps) at worst; strata do better.
        let limit = 0.5 / f64::from(around * rings).sqrt();
        assert!(noise < limit, "{noise}");
        assert!(wrong < full.len() / 20, "{wrong}");
        assert!(with_early_out < 1.25 * limit, "{with_early_out}");
        // The broken twin: a disk an eighth as wide.
        assert!(error(&full, &narrow).0 > 1.2 * noise);
    }
}

#[test]
fn contact_hardening_is_sharp_at_contacts_and_wide_far_from_them() {
    let Some(mut yard) = Yard::new() else { return };
    yard.points.truncate(1500);
    let widest = Radius::World(0.2);
    let (cube, flat) = (yard.cube_of(widest), yard.flat_of(widest));
    let light_size = 0.15;
    // A light disk that faces the ground.
    let exact = yard.exact(|yard, _, point| {
        let point = DVec3::new(point.x, 0.0, point.y);
        mean(|at| {
            let on_light = DVec3::new(at.x, 0.0, at.y) * f64::from(light_size);
            yard.sees(point, LIGHT.as_dvec3() + on_light)
        })
    });
    let kernel = |light_size| {
        Kernel::ContactHardening(ContactHardening {
            light_size,
            max_radius: widest,
            search_taps: 32,
            taps: 64,
        })
    };
    for (name, map) in [("cube", AnyMap::from(&cube)), ("flat", AnyMap::from(&flat))] {
        let (rms, _) = error(&yard.seen(map, kernel(light_size)), &exact);
        let (hard, _) = error(&yard.seen(map, Kernel::Bilinear), &exact);
        let (wide, _) = error(&yard.seen(map, kernel(10.0)), &exact);
        println!("{name} contact hardening: rms {rms:.4}; bilinear {hard:.4}; all wide {wide:.4}");
        // The broken twins: no penumbra at all, and the same one everywhere.
        assert!(
            rms < 0.7 * hard && rms < 0.8 * wide,
            "{name}: {rms} {hard} {wide}"
        );
    }
}

/// Points from the middle of a square's shadow to beyond its penumbra, and how much of a directional
/// light with a size they see.
fn under_a_square(half: f64, height: f64, light_size: f64) -> (Vec<(Vec3, Vec3)>, Vec<f64>) {
    let exact = |x: f64, z: f64| {
        mean(|at| {
            let over = DVec2::new(x, z) + at * light_size * height;
            f64::from(u8::from(over.abs().max_element() > half))
        })
    };
    (0..400)
        .map(|i| {
            let x = half * (f64::from(i) / 200.0);
            let z = 0.1 * half * f64::from(i % 7);
            ((Vec3::new(x as f32, 0.0, z as f32), Vec3::Y), exact(x, z))
        })
        .unzip()
}

#[test]
fn contact_hardening_is_as_wide_below_a_directional_map_as_on_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (half, light_size) = (0.25, 0.01);
    // The map ends right below its only caster; the ground is much farther down.
    for height in [2.0, 10.0] {
        let place = Affine3A::from_translation(Vec3::Y * height);
        let casters = [shapes::square(half).caster(&gpu.device, place)];
        let max_radius = Radius::World(1.5 * light_size * height);
        let descriptor = ShadowMapDescriptor {
            settings: MapSettings {
                reach: max_radius,
                ..Default::default()
            },
            ..Default::default()
        };
        let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
        let light = FlatLight::Directional(DirectionalLight::new(Vec3::Y));
        map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, &casters))
            .unwrap();
        gpu.run(|encoder| map.encode(encoder));
        let descriptor = PcfDescriptor {
            kernel: Kernel::ContactHardening(ContactHardening {
                light_size,
                max_radius,
                search_taps: 32,
                taps: 64,
            }),
            map: MapKind::FLAT,
            ..Default::default()
        };
        let (points, exact) = under_a_square(half.into(), height.into(), light_size.into());
        let rms = |change: fn(String) -> String| {
            let seen = ask_changed(&gpu, (&map).into(), &descriptor, 0, &points, change);
            let seen: Vec<_> = seen.into_iter().map(f64::from).collect();
            error(&seen, &exact).0
        };
        let right = rms(|module| module);
        // The broken twin: the ground taken for no farther than the map's end.
        let short = rms(|module| module.replace("select(-3e38, 0.0, receiver.spot)", "0.0"));
        println!("{height} above the ground: rms {right:.4}; at the map's end {short:.4}");
        assert!(right < 0.06 && short > 1.5 * right, "{right} {short}");
    }
}
