//! Every kernel against the same kernel with exact visibility: rays in f64 in the place of the map.

mod common;
#[path = "common/exact_kernels.rs"]
mod exact_kernels;
#[path = "../examples/host/mod.rs"]
mod host;
#[path = "common/receivers.rs"]
mod receivers;
#[path = "common/yard.rs"]
mod yard;

use exact_kernels::{SQUARES, TEXEL, mean, square, vogel};
use glam::DVec3;
use shadows::{AnyMap, ContactHardening, Kernel, Radius, RandomDisk, VogelDisk, glam};
use yard::{LIGHT, Yard, error};

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
    let cube = yard.cube();
    for (taps, radius) in [(4, 3.0), (16, 8.0), (64, 24.0)] {
        let radius_on_ground = radius * TEXEL;
        let exact = yard.exact(|yard, i, point| vogel(yard, i, point, taps, radius_on_ground));
        let unturned = yard.exact(|yard, _, point| vogel(yard, 0, point, taps, radius_on_ground));
        for radius in [
            Radius::Texels(radius as f32),
            Radius::World(radius_on_ground as f32),
        ] {
            let seen = yard.seen(&cube, Kernel::Vogel(VogelDisk { radius, taps }));
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
    let (cube, flat) = (yard.cube(), yard.flat());
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
            max_radius: Radius::World(0.2),
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
