//! Why a fan may replace the dark cap outside a caster's bounds, and why not inside: how often each
//! covers a direction, counted on the CPU.

use std::collections::HashMap;

use shadows::glam::{DVec3, Vec3};

use crate::shapes::{self, Shape};

/// +1 or -1 if the cone over a triangle of directions holds the direction, by its orientation.
fn covers(triangle: [DVec3; 3], direction: DVec3) -> i32 {
    let [a, b, c] = triangle;
    let turn = a.cross(b).dot(c);
    let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction));
    // With the other sign it is the opposite direction that the cone holds.
    if sides.iter().all(|side| side * turn > 0.0) {
        turn.signum() as i32
    } else {
        0
    }
}

/// The largest difference between cap and fan over many directions.
fn difference(shape: &Shape, light: DVec3) -> i32 {
    let corner = |i: u32| Vec3::from(shape.positions[i as usize]).as_dvec3();
    let mut cap = Vec::new();
    let mut boundary: HashMap<(u32, u32), i32> = HashMap::new();
    for &[a, b, c] in shape.indices.as_chunks::<3>().0 {
        let (p, q, r) = (corner(a), corner(b), corner(c));
        let triangle = match (q - p).cross(r - p).dot(light - p) {
            side if side > 0.0 => [a, b, c],
            side if side < 0.0 => [a, c, b],
            _ => continue,
        };
        cap.push(triangle.map(|i| corner(i) - light));
        for i in 0..3 {
            let (from, to) = (triangle[i], triangle[(i + 1) % 3]);
            let (key, sign) = if from < to {
                ((from, to), 1)
            } else {
                ((to, from), -1)
            };
            *boundary.entry(key).or_default() += sign;
        }
    }
    let bounds = shape.positions.iter().map(|&p| Vec3::from(p).as_dvec3());
    let (min, max) = bounds.fold((DVec3::MAX, DVec3::MIN), |(min, max), p| {
        (min.min(p), max.max(p))
    });
    let apex = (min + max) * 0.5 - light;
    let direction = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 997.0;
        let (sin, cos) = (f64::from(i) * 2.4).sin_cos();
        DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    };
    let along = |d: DVec3| {
        let cap: i32 = cap.iter().map(|t| covers(*t, d)).sum();
        let fan: i32 = boundary
            .iter()
            .map(|(&(a, b), m)| m * covers([corner(a) - light, corner(b) - light, apex], d))
            .sum();
        (cap - fan).abs()
    };
    (0..997).map(|i| along(direction(i))).max().unwrap_or(0)
}

fn room() -> Shape {
    shapes::sphere(9).cut(|corners| corners.iter().any(|c| c.y > -0.8))
}

#[test]
fn cap_and_fan_are_one_chain_for_a_light_outside() {
    for shape in [
        room(),
        shapes::fins(4).tilted(),
        shapes::square(1.0).tilted(),
    ] {
        for light in [
            DVec3::new(1.7, 0.31, 0.2),
            DVec3::new(-4.0, 9.0, 1.0),
            DVec3::new(0.1, -1.8, 0.3),
        ] {
            assert_eq!(difference(&shape, light), 0, "{light}");
        }
    }
}

#[test]
fn they_are_not_for_a_light_inside() {
    assert!(difference(&room(), DVec3::new(0.1, 0.2, 0.05)) > 0);
}
