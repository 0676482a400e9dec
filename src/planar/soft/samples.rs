//! Places of a light that stand for all of it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3, DVec4};

use super::frame::LightShape;
use crate::Light;

/// The light's places, homogeneous.
pub(super) fn places(light: &Light, shape: &LightShape, count: u32) -> Vec<DVec4> {
    let (middle, w) = match light {
        Light::Point(point) => (point.position.as_dvec3(), 1.0),
        Light::Spot(spot) => (spot.position.as_dvec3(), 1.0),
        Light::Directional(sun) => (sun.toward_light.as_dvec3().normalize(), 0.0),
    };
    let numbers = 0..count;
    let offset = |number: u32| match *shape {
        LightShape::Sphere { radius } if w == 0.0 => {
            f64::from(radius) * across(middle, spiral(number, count))
        }
        LightShape::Sphere { radius } => f64::from(radius) * in_ball(number),
        LightShape::Disk { radius, normal } => {
            f64::from(radius) * across(normal.as_dvec3().normalize(), spiral(number, count))
        }
        LightShape::Rectangle {
            half_width,
            half_height,
        } => {
            let [x, y] = in_square(number).map(|place| 2.0 * place - 1.0);
            x * half_width.as_dvec3() + y * half_height.as_dvec3()
        }
    };
    numbers
        .map(|number| (middle + offset(number)).extend(w))
        .collect()
}

/// A place across an axis of length 1.
fn across(axis: DVec3, place: DVec2) -> DVec3 {
    let (x, y) = axis.any_orthonormal_pair();
    place.x * x + place.y * y
}

/// Evenly in the unit disk, on a spiral of golden angles (Vogel, "A better way to construct the sunflower head",
/// 1979).
fn spiral(number: u32, count: u32) -> DVec2 {
    let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
    let radius = ((f64::from(number) + 0.5) / f64::from(count)).sqrt();
    radius * DVec2::from_angle(f64::from(number) * golden_angle)
}

/// Evenly in the unit square, whatever the number of places: multiples of the powers of 1/g, with
/// g = 1.3247 the root of g^3 = g + 1 (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
pub(super) fn in_square(number: u32) -> [f64; 2] {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    STEPS.map(|step| (0.5 + step * f64::from(number + 1)).fract())
}

/// In the unit ball, so that from whatever side they are seen places fill the ball's disk evenly: as densely as
/// 1 / sqrt(1 - r^2), of which the sum along every line of sight is the same (Abel's integral). With the root of
/// g^4 = g + 1 as in [`in_square`].
fn in_ball(number: u32) -> DVec3 {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_971_6,
    ];
    let [radius, height, angle] = STEPS.map(|step| (0.5 + step * f64::from(number + 1)).fract());
    let z = 2.0 * height - 1.0;
    let (sine, cosine) = (TAU * angle).sin_cos();
    let around = (1.0 - z * z).sqrt();
    radius_of(radius) * DVec3::new(around * cosine, around * sine, z)
}

/// The radius within which this part of a ball of that density lies: r = sin t, with
/// (t - sin t cos t) / (pi / 2) the part.
fn radius_of(part: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let (sine, cosine) = f64::sin_cos(middle);
        match (middle - sine * cosine) / FRAC_PI_2 < part {
            true => low = middle,
            false => high = middle,
        }
    }
    low.sin()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PointLight;
    use glam::Vec3;

    /// The part of places that lie within half the radius as seen along an axis, and their mean.
    fn seen_along(axis: DVec3, shape: &LightShape) -> (f64, DVec2) {
        let light = PointLight::new(Vec3::ZERO, 10.0).into();
        let places = places(&light, shape, 4000);
        let (x, y) = axis.normalize().any_orthonormal_pair();
        let seen: Vec<DVec2> = places
            .iter()
            .map(|place| DVec2::new(x.dot(place.truncate()), y.dot(place.truncate())))
            .collect();
        let within = seen.iter().filter(|place| place.length() < 1.0).count();
        let mean = seen.iter().sum::<DVec2>() / seen.len() as f64;
        assert!(seen.iter().all(|place| place.length() <= 2.0 + 1e-9));
        (within as f64 / seen.len() as f64, mean)
    }

    #[test]
    fn a_ball_is_an_even_disk_from_every_side() {
        let shape = LightShape::Sphere { radius: 2.0 };
        for axis in [DVec3::X, DVec3::Y, DVec3::new(1.0, -2.0, 0.5)] {
            let (within, mean) = seen_along(axis, &shape);
            assert!((within - 0.25).abs() < 0.01, "{axis}: {within}");
            // A hundredth of the radius.
            assert!(mean.length() < 0.02, "{axis}: {mean}");
        }
    }

    #[test]
    fn a_disk_is_even_along_its_normal_alone() {
        let normal = Vec3::new(0.3, 1.0, -0.2);
        let shape = LightShape::Disk {
            radius: 2.0,
            normal,
        };
        let (within, mean) = seen_along(normal.as_dvec3(), &shape);
        assert!((within - 0.25).abs() < 0.002 && mean.length() < 0.002);
        let (within, _) = seen_along(DVec3::X, &shape);
        assert!((within - 0.25).abs() > 0.1, "{within}");
    }
}
