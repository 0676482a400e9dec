//! What kernels say of a [`Yard`] where rays in f64 take the place of the map.
#![allow(dead_code)] // each test uses its own part

use shadows::glam::{DVec2, DVec3};
use shadows::{ContactHardening, Kernel, Radius};

use crate::receivers::pixel;
use crate::yard::{LIGHT, SIZE, Yard};

/// World width of a texel on the ground.
pub const TEXEL: f64 = 2.0 * 3.0 / SIZE as f64;

/// Taps along one axis (place in texels from the texel before the corner, weight), as published:
/// Castano, "Shadow Mapping Summary", The Witness, 2013. `s` is the place between texels.
fn published(kernel: Kernel, s: f64) -> Vec<(f64, f64)> {
    match kernel {
        Kernel::Bilinear | Kernel::HardwareBilinear => vec![(s, 1.0)],
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
pub fn square(yard: &Yard, kernel: Kernel, shift: f64, point: DVec2) -> f64 {
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

pub const SQUARES: [Kernel; 6] = [
    Kernel::Hard,
    Kernel::Bilinear,
    Kernel::FourTaps,
    Kernel::Weighted3,
    Kernel::Weighted5,
    Kernel::Weighted7,
];

/// Interleaved gradient noise, a turn for each pixel (Jimenez 2014).
fn turn(i: usize) -> DVec2 {
    let [x, y] = pixel(i).map(|p| f64::from(p.floor()));
    let noise = (52.982_918_9 * (0.067_110_56 * x + 0.005_837_15 * y).fract()).fract();
    DVec2::from_angle(noise * std::f64::consts::TAU)
}

/// Vogel's spiral turned, each tap an exact ray. `axes` turns the disk's first axis into z and its
/// second into x: the radius, with their signs.
pub fn vogel(yard: &Yard, i: usize, point: DVec2, taps: u32, axes: DVec2) -> f64 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let turn = turn(i);
    let lit = (0..taps).map(|tap| {
        let tap = f64::from(tap);
        let offset = DVec2::from_angle(tap * golden) * ((tap + 0.5) / f64::from(taps)).sqrt();
        let offset = turn.rotate(offset);
        yard.lit(point + DVec2::new(offset.y, offset.x) * axes)
    });
    lit.sum::<f64>() / f64::from(taps)
}

/// The mean over a disk of the ground, or over a light that faces it, of 1,024 rays.
pub fn mean(lit: impl Fn(DVec2) -> f64) -> f64 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let sample = |i: u32| {
        let i = f64::from(i);
        lit(DVec2::from_angle(i * golden) * ((i + 0.5) / 1024.0).sqrt())
    };
    (0..1024).map(sample).sum::<f64>() / 1024.0
}

/// The weight of a texel whose centre is so many texels from the receiver, along one axis.
fn weight(kernel: Kernel, delta: f64) -> f64 {
    // Every distance belongs to one texel and one place between texels.
    let texel = delta.ceil();
    let taps = published(kernel, texel - delta);
    let total: f64 = taps.iter().map(|tap| tap.1).sum();
    let share = |&(place, weight): &(f64, f64)| {
        let fraction = place - place.floor();
        match texel - place.floor() {
            0.0 => weight * (1.0 - fraction),
            1.0 => weight * fraction,
            _ => 0.0,
        }
    };
    taps.iter().map(share).sum::<f64>() / total
}

/// What a square of texels would say if there were no texels: the mean over its footprint with its
/// own weights.
pub fn endless_square(yard: &Yard, kernel: Kernel, point: DVec2) -> f64 {
    let Radius::Texels(reach) = kernel.radius() else {
        unreachable!("squares are measured in texels")
    };
    if kernel == Kernel::Hard {
        return yard.lit(point);
    }
    const STEPS: i32 = 24;
    let place = |i: i32| f64::from(reach) * ((2 * i + 1) as f64 / f64::from(STEPS) - 1.0);
    let weights: Vec<f64> = (0..STEPS).map(|i| weight(kernel, place(i))).collect();
    let (mut sum, mut total) = (0.0, 0.0);
    for (y, down) in (0..).zip(&weights) {
        for (x, across) in (0..).zip(&weights) {
            let offset = DVec2::new(place(x), place(y)) * TEXEL;
            sum += down * across * yard.lit(point + offset);
            total += down * across;
        }
    }
    sum / total
}

/// What a disk of so many texels would say with endless taps.
pub fn endless_disk(yard: &Yard, radius: f64, point: DVec2) -> f64 {
    mean(|at| yard.lit(point + at * radius * TEXEL))
}

/// What contact hardening would say with endless taps of an endless map.
pub fn endless_contact(yard: &Yard, contact: &ContactHardening, point: DVec2) -> f64 {
    let Radius::Texels(widest) = contact.max_radius else {
        unreachable!("these tests ask for texels")
    };
    let widest = f64::from(widest) * TEXEL;
    let light = LIGHT.as_dvec3();
    let ray = DVec2::new(point.x - light.x, point.y - light.z);
    let stretch = (1.0 + ray.length_squared() / (light.y * light.y))
        .sqrt()
        .min(4.0);
    let along = ray.try_normalize().unwrap_or(DVec2::X);
    let disk =
        |radius: f64, at: DVec2| point + radius * (stretch * at.x * along + at.y * along.perp());
    let blockers = std::cell::RefCell::new(Vec::new());
    let clear = mean(|at| match yard.blocker(disk(widest, at)) {
        Some(t) => {
            blockers.borrow_mut().push(1.0 / t);
            0.0
        }
        None => 1.0,
    });
    let blockers = blockers.into_inner();
    if clear == 1.0 || clear == 0.0 {
        return clear;
    }
    let gap = blockers.iter().sum::<f64>() / blockers.len() as f64 - 1.0;
    let radius = (f64::from(contact.light_size) * gap).clamp(TEXEL.min(widest), widest);
    mean(|at| yard.lit(disk(radius, at)))
}

/// How much of a spherical light a point sees: 1,024 places on its disk, which faces the point.
pub fn area_light(yard: &Yard, light_size: f64, point: DVec2) -> f64 {
    let (point, light) = (DVec3::new(point.x, 0.0, point.y), LIGHT.as_dvec3());
    let (across, along) = (point - light).normalize().any_orthonormal_pair();
    mean(|at| {
        let on_light = light_size * (at.x * across + at.y * along);
        yard.sees(point, light + on_light)
    })
}
