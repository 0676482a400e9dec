//! Every kernel against the same kernel with exact visibility: rays in f64 in the place of the map.

mod common;
#[path = "../examples/host/mod.rs"]
mod host;
#[path = "common/receivers.rs"]
mod receivers;

use common::rays::Triangles;
use common::shapes::{Random, cuboid};
use glam::{Affine3A, DVec2, DVec3, Vec3};
use host::gpu::Gpu;
use receivers::{pixel, visibility};
use shadows::{
    AnyMap, Caster, ContactHardening, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, FlatLight,
    Kernel, PointLight, Radius, RandomDisk, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight,
    VogelDisk, glam,
};

const SIZE: u32 = 512;
const LIGHT: Vec3 = Vec3::new(0.0, 3.0, 0.0);

/// Boxes between a light and the ground y = 0, seen straight down by one face of a cube map or by
/// a spot with the same frustum.
struct Yard {
    gpu: Gpu,
    casters: Vec<Caster>,
    truth: Triangles,
    points: Vec<Vec3>,
}

impl Yard {
    fn new() -> Option<Self> {
        let gpu = Gpu::for_test()?;
        let mut random = Random::new(21);
        let shape = cuboid(Vec3::new(0.25, 0.15, 0.2));
        let mesh = shape.mesh(&gpu.device);
        let mut truth = Triangles::default();
        let casters = (0..10)
            .map(|_| {
                let place = random.vec3() * Vec3::new(1.2, 0.5, 1.2) + Vec3::Y * 0.8;
                let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0);
                let transform = Affine3A::from_translation(place) * turn;
                truth.add(&shape.positions, &shape.indices, transform);
                Caster::new(mesh.clone(), transform)
            })
            .collect();
        let points = (0..4000)
            .map(|_| Vec3::new(random.next() * 2.0, 0.0, random.next() * 2.0))
            .collect();
        Some(Self {
            gpu,
            casters,
            truth,
            points,
        })
    }

    fn cube(&self) -> CubeShadowMap {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            ..Default::default()
        };
        let mut map = CubeShadowMap::new(device, &descriptor).unwrap();
        let frame = CubeFrame {
            lights: &[PointLight::new(LIGHT, 0.05, 30.0)],
            casters: &self.casters,
            ..Default::default()
        };
        map.prepare(device, queue, &frame).unwrap();
        self.gpu.run(|encoder| map.encode(encoder));
        map
    }

    /// The spot with the cube face's frustum; its axes are the face's up to signs.
    fn flat(&self) -> ShadowMap {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let descriptor = ShadowMapDescriptor {
            size: SIZE,
            ..Default::default()
        };
        let mut map = ShadowMap::new(device, &descriptor).unwrap();
        let light = FlatLight::Spot(SpotLight {
            position: LIGHT,
            direction: Vec3::NEG_Y,
            half_angle: std::f32::consts::FRAC_PI_4,
            near: 0.05,
            range: 30.0,
        });
        map.prepare(device, queue, &ShadowFrame::new(light, &self.casters))
            .unwrap();
        self.gpu.run(|encoder| map.encode(encoder));
        map
    }

    fn seen<'a>(&self, map: impl Into<AnyMap<'a>>, kernel: Kernel) -> Vec<f64> {
        let points: Vec<_> = self.points.iter().map(|point| (*point, Vec3::Y)).collect();
        let seen = visibility(&self.gpu, map, kernel, &points);
        seen.into_iter().map(f64::from).collect()
    }

    /// Whether a point sees another.
    fn sees(&self, from: DVec3, to: DVec3) -> f64 {
        let hit = self.truth.nearest(from, to - from);
        f64::from(u8::from(hit.is_none_or(|t| t >= 1.0)))
    }

    fn lit(&self, point: DVec2) -> f64 {
        self.sees(LIGHT.as_dvec3(), DVec3::new(point.x, 0.0, point.y))
    }

    /// The kernel's answer at every point.
    fn exact(&self, kernel: impl Fn(&Self, usize, DVec2) -> f64) -> Vec<f64> {
        let points = self.points.iter().enumerate();
        points
            .map(|(i, point)| kernel(self, i, point.as_dvec3().truncate_y()))
            .collect()
    }
}

trait Ground {
    fn truncate_y(self) -> DVec2;
}

impl Ground for DVec3 {
    fn truncate_y(self) -> DVec2 {
        DVec2::new(self.x, self.z)
    }
}

/// Root mean square and largest difference.
fn error(seen: &[f64], exact: &[f64]) -> (f64, f64) {
    let differences = seen
        .iter()
        .zip(exact)
        .map(|(seen, exact)| (seen - exact).abs());
    let largest = differences.clone().fold(0.0, f64::max);
    let squares: f64 = differences.map(|difference| difference * difference).sum();
    ((squares / seen.len() as f64).sqrt(), largest)
}

/// World width of a texel on the ground.
const TEXEL: f64 = 2.0 * 3.0 / SIZE as f64;

/// Taps along one axis (place in texels from the texel before the corner, weight), as published:
/// Castano, "Shadow Mapping Summary", The Witness, 2013. `s` is the place between texels.
fn published(kernel: Kernel, s: f64) -> Vec<(f64, f64)> {
    match kernel {
        Kernel::Bilinear => vec![(s, 1.0)],
        Kernel::FourTaps => vec![(s - 1.0, 0.5), (s + 1.0, 0.5)],
        Kernel::Weighted3 => {
            let w = [3.0 - 2.0 * s, 1.0 + 2.0 * s];
            vec![((2.0 - s) / w[0] - 1.0, w[0]), (s / w[1] + 1.0, w[1])]
        }
        Kernel::Weighted5 => {
            let w = [4.0 - 3.0 * s, 7.0, 1.0 + 3.0 * s];
            vec![
                ((3.0 - 2.0 * s) / w[0] - 2.0, w[0]),
                ((3.0 + s) / w[1], w[1]),
                (s / w[2] + 2.0, w[2]),
            ]
        }
        Kernel::Weighted7 => {
            let w = [
                5.0 * s - 6.0,
                11.0 * s - 28.0,
                -(11.0 * s + 17.0),
                -(5.0 * s + 1.0),
            ];
            vec![
                ((4.0 * s - 5.0) / w[0] - 3.0, w[0]),
                ((4.0 * s - 16.0) / w[1] - 1.0, w[1]),
                (-(7.0 * s + 5.0) / w[2] + 1.0, w[2]),
                (-s / w[3] + 3.0, w[3]),
            ]
        }
        _ => unreachable!("no square of texels"),
    }
}

/// What bilinear taps at the published places say where every texel is exact.
fn square(yard: &Yard, kernel: Kernel, shift: f64, point: DVec2) -> f64 {
    let place = point / TEXEL + f64::from(SIZE / 2) + shift;
    let lit = |x: f64, y: f64| {
        let centre = DVec2::new(x, y) + 0.5 - f64::from(SIZE / 2);
        yard.lit(centre * TEXEL)
    };
    if kernel == Kernel::Hard {
        return lit(place.x.floor(), place.y.floor());
    }
    let corner = (place + 0.5).floor();
    let s = place + 0.5 - corner;
    let (mut sum, mut total) = (0.0, 0.0);
    for (y, down) in published(kernel, s.y) {
        for (x, across) in published(kernel, s.x) {
            let (fx, fy) = (x - x.floor(), y - y.floor());
            let (x, y) = (corner.x - 1.0 + x.floor(), corner.y - 1.0 + y.floor());
            let top = lit(x, y) * (1.0 - fx) + lit(x + 1.0, y) * fx;
            let bottom = lit(x, y + 1.0) * (1.0 - fx) + lit(x + 1.0, y + 1.0) * fx;
            sum += across * down * (top * (1.0 - fy) + bottom * fy);
            total += across * down;
        }
    }
    sum / total
}

const SQUARES: [Kernel; 6] = [
    Kernel::Hard,
    Kernel::Bilinear,
    Kernel::FourTaps,
    Kernel::Weighted3,
    Kernel::Weighted5,
    Kernel::Weighted7,
];

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

/// Interleaved gradient noise, a turn for each pixel (Jimenez 2014).
fn turn(i: usize) -> DVec2 {
    let [x, y] = pixel(i).map(|p| f64::from(p.floor()));
    let noise = (52.982_918_9 * (0.067_110_56 * x + 0.005_837_15 * y).fract()).fract();
    DVec2::from_angle(noise * std::f64::consts::TAU)
}

/// Vogel's spiral turned, each tap an exact ray.
fn vogel(yard: &Yard, i: usize, point: DVec2, taps: u32, radius: f64) -> f64 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let turn = turn(i);
    let lit = (0..taps).map(|tap| {
        let tap = f64::from(tap);
        let offset = DVec2::from_angle(tap * golden) * ((tap + 0.5) / f64::from(taps)).sqrt();
        let offset = turn.rotate(offset) * radius;
        // The disk's axes on the ground: first -z, then -x.
        yard.lit(point - DVec2::new(offset.y, offset.x))
    });
    lit.sum::<f64>() / f64::from(taps)
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

/// The mean over a disk of the ground, or over a light that faces it, of 1,024 rays.
fn mean(lit: impl Fn(DVec2) -> f64) -> f64 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let sample = |i: u32| {
        let i = f64::from(i);
        lit(DVec2::from_angle(i * golden) * ((i + 0.5) / 1024.0).sqrt())
    };
    (0..1024).map(sample).sum::<f64>() / 1024.0
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
