//! How soft edges look: every kernel against what it would say with endless taps of an endless map,
//! and against an area light; its banding, its noise, and what flickers when the camera moves.

use crate::exact_kernels::{TEXEL, area_light, endless_contact, endless_disk, endless_square};
use crate::receivers::{ask_changed, visibility};
use crate::yard::{Yard, error};
use glam::{Affine3A, Vec2, Vec3};
use shadows::{
    AnyMap, ContactHardening, CubeShadowMap, Kernel, PcfDescriptor, RandomDisk, ShadowMap,
    VogelDisk, glam,
};

/// Pixels of the picture; as wide as the pattern that [`crate::receivers::pixel`] numbers.
const WIDTH: usize = 64;
const HEIGHT: usize = 24;
/// World width of a pixel: texels and pixels have nothing in common.
const PIXEL: f32 = 0.73 * TEXEL as f32;
const LIGHT_SIZE: f32 = 0.1;

/// The kernels of which figures are told; disks without parameters that hide their noise.
fn kernels() -> [Kernel; 11] {
    let disk = |early_out| {
        Kernel::RandomDisk(RandomDisk {
            early_out,
            ..Default::default()
        })
    };
    let [hard, bilinear, four, three, five, seven, hardware, ..] = Kernel::ALL;
    let vogel = Kernel::Vogel(VogelDisk::default());
    let contact = Kernel::ContactHardening(contact());
    [
        hard,
        bilinear,
        four,
        three,
        five,
        seven,
        hardware,
        disk(true),
        disk(false),
        vogel,
        contact,
    ]
}

fn contact() -> ContactHardening {
    ContactHardening {
        light_size: LIGHT_SIZE,
        ..Default::default()
    }
}

/// A box on the ground and a slab above it, so that there is a contact and a wide penumbra.
fn yard() -> Option<Yard> {
    let turn = Affine3A::from_rotation_y(0.35);
    let stands = Affine3A::from_translation(Vec3::new(0.45, 0.15, 0.1)) * turn;
    let hangs =
        Affine3A::from_translation(Vec3::new(0.36, 0.9, -0.02)) * Affine3A::from_rotation_y(-0.6);
    Yard::of(
        &[
            (Vec3::new(0.1, 0.15, 0.12), stands),
            (Vec3::new(0.12, 0.02, 0.06), hangs),
        ],
        picture(0.0),
    )
}

/// Points of the ground under the pixels of a camera turned against the map, moved by so many
/// pixels.
fn picture(moved: f32) -> Vec<Vec3> {
    let turn = Vec2::from_angle(0.3);
    (0..WIDTH * HEIGHT)
        .map(|i| {
            let pixel = Vec2::new((i % WIDTH) as f32 + moved, (i / WIDTH) as f32);
            let middle = Vec2::new(WIDTH as f32, HEIGHT as f32) * 0.5;
            let at = Vec2::new(0.55, 0.0) + turn.rotate((pixel - middle) * PIXEL);
            Vec3::new(at.x, 0.0, at.y)
        })
        .collect()
}

/// The kernel with endless taps of an endless map.
fn endless(yard: &Yard, kernel: Kernel) -> Vec<f64> {
    yard.exact(|yard, _, point| match kernel {
        Kernel::RandomDisk(_) | Kernel::Vogel(_) => endless_disk(yard, 3.0, point),
        Kernel::ContactHardening(contact) => endless_contact(yard, &contact, point),
        square => endless_square(yard, square, point),
    })
}

/// Differences between pixels side by side.
fn steps(values: &[f64]) -> impl Iterator<Item = f64> + '_ {
    (0..values.len())
        .filter(|i| i % WIDTH != WIDTH - 1)
        .map(|i| values[i + 1] - values[i])
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v * v, count + 1));
    (sum / f64::from(count)).sqrt()
}

/// Standard deviation of what is not the exact kernel's from one pixel to the next.
fn noise(seen: &[f64], exact: &[f64]) -> f64 {
    let beyond = steps(seen)
        .zip(steps(exact))
        .map(|(seen, exact)| seen - exact);
    root_mean_square(beyond) / 2.0_f64.sqrt()
}

/// Banding: how much larger a step from one pixel to the next is than the exact kernel's, at most.
fn largest_step(seen: &[f64], exact: &[f64]) -> f64 {
    let beyond = steps(seen)
        .zip(steps(exact))
        .map(|(seen, exact)| seen.abs() - exact.abs());
    beyond.fold(0.0, f64::max)
}

/// The share of pixels that change by a twentieth of visibility more than the exact kernel does.
fn flips(before: [&[f64]; 2], after: [&[f64]; 2]) -> f64 {
    let count = before[0].len();
    let change = |which: usize, i: usize| (after[which][i] - before[which][i]).abs();
    let flipped = (0..count).filter(|&i| change(0, i) > change(1, i) + 0.05);
    flipped.count() as f64 / count as f64
}

/// How many values of visibility there are.
fn levels(seen: &[f64]) -> usize {
    let rounded = seen.iter().map(|value| (value * 1e4).round() as u64);
    rounded.collect::<std::collections::BTreeSet<_>>().len()
}

/// What is measured once for all kernels.
struct Studio {
    yard: Yard,
    cube: CubeShadowMap,
    flat: ShadowMap,
    area: Vec<f64>,
}

impl Studio {
    fn new() -> Option<Self> {
        let yard = yard()?;
        let (cube, flat) = (yard.cube(), yard.flat());
        let area = yard.exact(|yard, _, point| area_light(yard, LIGHT_SIZE.into(), point));
        Some(Self {
            yard,
            cube,
            flat,
            area,
        })
    }

    fn maps(&self) -> [(&'static str, AnyMap<'_>); 2] {
        [("cube", (&self.cube).into()), ("flat", (&self.flat).into())]
    }

    fn seen(&self, map: AnyMap<'_>, kernel: Kernel, moved: f32) -> Vec<f64> {
        let points: Vec<_> = picture(moved).iter().map(|&at| (at, Vec3::Y)).collect();
        let seen = visibility(&self.yard.gpu, map, kernel, &points);
        seen.into_iter().map(f64::from).collect()
    }

    /// The same with every point at the pixel that is its neighbour's.
    fn slipped(&self, map: AnyMap<'_>, kernel: Kernel, moved: f32) -> Vec<f64> {
        let mut points: Vec<_> = picture(moved).iter().map(|&at| (at, Vec3::Y)).collect();
        points.rotate_left(1);
        let mut seen = visibility(&self.yard.gpu, map, kernel, &points);
        seen.rotate_right(1);
        seen.into_iter().map(f64::from).collect()
    }

    /// The kernel's exact values, and those of the picture moved by a tenth of a pixel.
    fn exact(&mut self, kernel: Kernel) -> [Vec<f64>; 2] {
        [0.0, 0.1].map(|moved| {
            self.yard.points = picture(moved);
            endless(&self.yard, kernel)
        })
    }
}

/// The most that each of [`kernels`] may have, a quarter above what it has: root mean square and
/// largest difference from itself with endless taps of an endless map, noise, largest step, and share
/// of flips.
const LIMITS: [[f64; 5]; 11] = [
    [0.165, 1.0, 0.165, 1.0, 0.004],
    [0.059, 0.55, 0.049, 0.50, 0.001],
    [0.028, 0.15, 0.022, 0.13, 0.001],
    [0.024, 0.175, 0.0125, 0.125, 0.001],
    [0.0165, 0.10, 0.006, 0.055, 0.001],
    [0.015, 0.09, 0.0055, 0.045, 0.001],
    [0.059, 0.55, 0.049, 0.50, 0.001],
    [0.0315, 0.175, 0.028, 0.20, 0.015],
    [0.031, 0.175, 0.0275, 0.20, 0.0125],
    [0.036, 0.20, 0.0335, 0.24, 0.056],
    [0.028, 0.20, 0.026, 0.16, 0.0165],
];

/// A kernel without taps or texels: of the picture, of the picture moved by a tenth of a pixel.
struct Endless<'a> {
    here: &'a [f64],
    moved: &'a [f64],
}

impl Endless<'_> {
    /// What [`LIMITS`] is about.
    fn figures(&self, seen: &[f64], moved: &[f64]) -> [f64; 5] {
        let (rms, largest) = error(seen, self.here);
        let noise = noise(seen, self.here);
        let step = largest_step(seen, self.here);
        let flips = flips([seen, self.here], [moved, self.moved]);
        [rms, largest, noise, step, flips]
    }
}

fn within(figures: [f64; 5], limits: [f64; 5]) -> [bool; 5] {
    std::array::from_fn(|i| figures[i] <= limits[i])
}

#[test]
fn every_kernel_is_near_what_it_is_with_endless_taps() {
    let Some(mut studio) = Studio::new() else {
        return;
    };
    let part = studio.area.iter().filter(|v| **v > 0.0 && **v < 1.0);
    assert!(part.count() > WIDTH * HEIGHT / 4, "little penumbra");
    println!("rms largest noise step flips | area: rms largest | levels");
    for (kernel, limits) in kernels().into_iter().zip(LIMITS) {
        let [here, moved] = studio.exact(kernel);
        let endless = Endless {
            here: &here,
            moved: &moved,
        };
        for (name, map) in studio.maps() {
            judge(&studio, (name, map), kernel, &endless, limits);
        }
    }
}

fn judge(
    studio: &Studio,
    (name, map): (&str, AnyMap<'_>),
    kernel: Kernel,
    endless: &Endless<'_>,
    limits: [f64; 5],
) {
    let [seen, moved] = [0.0, 0.1].map(|moved| studio.seen(map, kernel, moved));
    let figures = endless.figures(&seen, &moved);
    let area = error(&seen, &studio.area);
    let levels = levels(&seen);
    println!("{figures:.3?} | {area:.3?} | {levels} {name} {kernel:?}");
    assert_eq!(
        within(figures, limits),
        [true; 5],
        "{name} {kernel:?}: {figures:?}"
    );
    // The broken twins. Seen two pixels beside where it is:
    let beside = studio.seen(map, kernel, 2.0);
    let [near, nowhere_far, ..] = within(endless.figures(&beside, &moved), limits);
    assert!(!near, "{name} {kernel:?}: beside");
    assert!(!nowhere_far || kernel == Kernel::Hard, "{name} {kernel:?}");
    // One tap in its place:
    let hard = studio.seen(map, Kernel::Hard, 0.0);
    let [_, _, quiet, smooth, _] = within(endless.figures(&hard, &moved), limits);
    assert!(
        !(quiet || smooth) || kernel == Kernel::Hard,
        "{name} {kernel:?}: one tap"
    );
    // A camera that moves five times as far:
    let far = studio.seen(map, kernel, 0.5);
    let [.., still] = within(endless.figures(&seen, &far), limits);
    assert!(!still, "{name} {kernel:?}: moves far");
    // A pattern that does not stay with its pixels:
    let slipped = studio.slipped(map, kernel, 0.1);
    let [.., still] = within(endless.figures(&seen, &slipped), limits);
    assert_eq!(!still, kernel.uses_pixel(), "{name} {kernel:?}: slipped");
}

#[test]
fn blockers_are_looked_for_as_far_as_the_widest_penumbra_reaches() {
    let Some(studio) = Studio::new() else { return };
    // A light so large that every penumbra is the widest.
    let wide = ContactHardening {
        light_size: 100.0,
        search_taps: 16,
        taps: 64,
        ..contact()
    };
    let endless = studio
        .yard
        .exact(|yard, _, point| endless_contact(yard, &wide, point));
    let points: Vec<_> = picture(0.0).iter().map(|&at| (at, Vec3::Y)).collect();
    for (name, map) in studio.maps() {
        let descriptor = PcfDescriptor {
            kernel: Kernel::ContactHardening(wide),
            map: map.kind(),
            ..Default::default()
        };
        let rms = |change: fn(String) -> String| {
            let gpu = &studio.yard.gpu;
            let seen = ask_changed(gpu, map, &descriptor, 0, &points, change);
            let seen: Vec<_> = seen.into_iter().map(f64::from).collect();
            error(&seen, &endless).0
        };
        let right = rms(|module| module);
        // The broken twin: the search's taps on half the disk's radius.
        let narrow = rms(|module| module.replace("spread * widest", "widest"));
        println!("{name}: rms {right:.4}, searched on half the radius {narrow:.4}");
        assert!(
            right < 0.03 && narrow > 2.0 * right,
            "{name}: {right} {narrow}"
        );
    }
}

#[test]
fn contact_hardening_comes_nearest_to_an_area_light() {
    let Some(studio) = Studio::new() else { return };
    for (name, map) in studio.maps() {
        let rms = |kernel| error(&studio.seen(map, kernel, 0.0), &studio.area).0;
        let nearest = rms(Kernel::ContactHardening(contact()));
        for kernel in &kernels()[..9] {
            assert!(rms(*kernel) > 1.1 * nearest, "{name} {kernel:?}");
        }
        // The broken twins: lights of other sizes.
        for light_size in [0.3 * LIGHT_SIZE, 3.0 * LIGHT_SIZE] {
            let other = ContactHardening {
                light_size,
                ..contact()
            };
            assert!(rms(Kernel::ContactHardening(other)) > 1.1 * nearest);
        }
    }
}
