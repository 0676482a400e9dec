//! Stone for the courtyard: columns, arcades, mouldings, stairs, urns. All closed; metres.

use std::f64::consts::PI;

use shadows::glam::{DAffine3, DVec2, DVec3, dvec2, dvec3};

use super::Mesh;
use super::surface::Surface;

/// Height of [`column`] and of the springing of [`arcade`] when it stands on columns.
pub const COLUMN_HEIGHT: f64 = 3.2;
/// Distance between the axes of neighbouring columns.
pub const BAY: f64 = 3.0;
/// Height of [`arcade`] above its springing.
pub const ARCADE_HEIGHT: f64 = 1.75;
/// Steps in [`stairs`].
pub const STEPS: u32 = 14;
/// Height of a step.
pub const RISE: f64 = 0.17;
/// Depth of a step.
pub const GOING: f64 = 0.32;

const ARCH_RADIUS: f64 = 1.1;
const WALL_HALF: f64 = 0.3;
const FLUTES: f64 = 20.0;

/// A box from -1 to 1 along x and z and from 0 to 1 along y, to be scaled.
pub fn block() -> Mesh {
    Surface::cuboid(dvec3(-1.0, 0.0, -1.0), dvec3(1.0, 1.0, 1.0)).finish("block", 30.0)
}

/// A fluted column on an Attic base, with a round capital; its foot is at the origin.
pub fn column() -> Mesh {
    let mut s = Surface::cuboid(dvec3(-0.42, 0.0, -0.42), dvec3(0.42, 0.14, 0.42));
    let abacus = [dvec3(-0.43, 3.05, -0.43), dvec3(0.43, COLUMN_HEIGHT, 0.43)];
    s.add(&Surface::cuboid(abacus[0], abacus[1]), DAffine3::IDENTITY);
    let turned = Surface::turned(&column_profile(), 80, |p, angle| {
        // Flutes start and end in the plain bands next to the mouldings.
        let fade = ((p.y - 0.58) / 0.07)
            .min((2.66 - p.y) / 0.07)
            .clamp(0.0, 1.0);
        p.x * (1.0 - 0.075 * fade * (0.5 * FLUTES * angle).sin().abs())
    });
    s.add(&turned, DAffine3::IDENTITY);
    s.finish("column", 40.0)
}

/// (radius, height) from the axis inside the plinth to the axis inside the abacus.
fn column_profile() -> Vec<DVec2> {
    let mut p = vec![dvec2(0.0, 0.1), dvec2(0.36, 0.1)];
    p.extend(roll(0.36, 0.2, 0.055, 6));
    p.extend([(0.345, 0.27), (0.325, 0.3), (0.325, 0.34), (0.34, 0.37)].map(|(r, y)| dvec2(r, y)));
    p.extend(roll(0.335, 0.42, 0.04, 5));
    p.extend([dvec2(0.32, 0.48), dvec2(0.305, 0.54)]);
    for i in 0..=12 {
        let t = f64::from(i) / 12.0;
        // Entasis: the shaft narrows by a sixth, more so near the top.
        p.push(dvec2(0.3 - 0.05 * t * t, 0.58 + 2.08 * t));
    }
    p.extend(roll(0.25, 2.72, 0.025, 4));
    p.extend([dvec2(0.255, 2.78), dvec2(0.26, 2.84)]);
    for i in 1..=6 {
        let t = 0.5 * PI * f64::from(i) / 6.0;
        p.push(dvec2(0.26 + 0.14 * t.sin(), 3.0 - 0.16 * t.cos()));
    }
    p.extend([dvec2(0.4, 3.1), dvec2(0.0, 3.1)]);
    p
}

/// A half-round moulding that bulges from `radius`, around height `y`.
fn roll(radius: f64, y: f64, size: f64, steps: u32) -> impl Iterator<Item = DVec2> {
    (0..=steps).map(move |i| {
        let t = PI * (f64::from(i) / f64::from(steps) - 0.5);
        dvec2(radius + size * t.cos(), y + size * t.sin())
    })
}

/// A wall on `bays` round arches along x, centred on x = 0, from y = 0 (the springing) up. It ends
/// in half a pier beyond the axes of its outermost columns.
pub fn arcade(bays: u32) -> Mesh {
    const SEGMENTS: u32 = 40;
    let left = -0.5 * f64::from(bays) * BAY;
    let pier = 0.5 * BAY - ARCH_RADIUS;
    let mut foot = vec![dvec2(left - pier, 0.0)];
    for bay in 0..bays {
        let middle = left + (f64::from(bay) + 0.5) * BAY;
        foot.extend((0..=SEGMENTS).map(|i| {
            let a = PI * f64::from(SEGMENTS - i) / f64::from(SEGMENTS);
            let height = if i % SEGMENTS == 0 { 0.0 } else { a.sin() };
            dvec2(middle + ARCH_RADIUS * a.cos(), ARCH_RADIUS * height)
        }));
    }
    foot.push(dvec2(-left + pier, 0.0));

    let n = foot.len() as u32;
    let top = foot.iter().rev().map(|p| dvec2(p.x, ARCADE_HEIGHT));
    let outline: Vec<DVec2> = foot.iter().copied().chain(top).collect();
    let mut triangles = Vec::new();
    for i in 0..n - 1 {
        let [a, b] = [2 * n - 1 - i, 2 * n - 2 - i];
        triangles.extend([[i, i + 1, b], [i, b, a]]);
    }
    Surface::plate(&outline, &triangles, (-WALL_HALF, WALL_HALF))
        .finish(&format!("arcade of {bays}"), 30.0)
}

/// The round moulding over one arch, in the plane z = 0 above y = 0.
pub fn archivolt() -> Mesh {
    half_ring(ARCH_RADIUS + 0.09, 0.075, 48, 12).finish("archivolt", 50.0)
}

/// The upper half of a ring in the plane z = 0, closed at both ends.
pub fn half_ring(radius: f64, section: f64, segments: u32, sectors: u32) -> Surface {
    Surface::swept((0..=segments).map(|i| {
        let a = PI * f64::from(i) / f64::from(segments);
        let out = dvec3(a.cos(), a.sin(), 0.0);
        let row = (0..sectors).map(move |k| {
            let t = 2.0 * PI * f64::from(k) / f64::from(sectors);
            out * (radius + section * t.cos()) + DVec3::Z * (section * t.sin())
        });
        (out * radius, row.collect())
    }))
}

/// The small blocks under the cornice along one bay, centred on x = 0, their tops at y = 0.
pub fn dentils() -> Mesh {
    const COUNT: u32 = 15;
    let mut s = Surface::default();
    let pitch = BAY / f64::from(COUNT);
    for i in 0..COUNT {
        let x = (f64::from(i) + 0.5) * pitch - 0.5 * BAY;
        let half = 0.27 * pitch;
        let ends = [dvec3(x - half, -0.14, -0.37), dvec3(x + half, 0.0, 0.37)];
        s.add(&Surface::cuboid(ends[0], ends[1]), DAffine3::IDENTITY);
    }
    s.finish("dentils", 30.0)
}

/// A flight of [`STEPS`] steps that rises along +x from the origin, `width` wide around z = 0.
pub fn stairs(width: f64) -> Mesh {
    let foot = (0..=STEPS).map(|i| dvec2(f64::from(i) * GOING, 0.0));
    let treads = (0..STEPS).rev().flat_map(|i| {
        let [x, y] = [f64::from(i) * GOING, f64::from(i + 1) * RISE];
        [dvec2(x + GOING, y), dvec2(x, y)]
    });
    let outline: Vec<DVec2> = foot.chain(treads).collect();
    let back = |i: u32| STEPS + 1 + 2 * (STEPS - 1 - i);
    let front = |i: u32| back(i) + 1;
    let mut triangles = Vec::new();
    for i in 0..STEPS {
        // Each step shares a corner in the middle of its left side with the step below, so that
        // there is no T-junction.
        let below = if i == 0 { 0 } else { back(i - 1) };
        triangles.push([i + 1, back(i), front(i)]);
        triangles.push([i + 1, front(i), below]);
        if i > 0 {
            triangles.push([i + 1, below, i]);
        }
    }
    Surface::plate(&outline, &triangles, (-0.5 * width, 0.5 * width)).finish("stairs", 30.0)
}

/// A hollow urn with two handles, 1.28 high, its foot at the origin.
pub fn urn() -> Mesh {
    let outline = [
        (0.24, 0.0),
        (0.25, 0.05),
        (0.13, 0.13),
        (0.14, 0.18),
        (0.36, 0.48),
        (0.45, 0.74),
        (0.38, 0.98),
        (0.21, 1.12),
        (0.21, 1.2),
        (0.3, 1.26),
        (0.29, 1.28),
        (0.17, 1.2),
        (0.17, 1.12),
        (0.32, 0.96),
        (0.38, 0.74),
        (0.2, 0.4),
    ]
    .map(|(r, y)| dvec2(r, y));
    let mut profile = vec![dvec2(0.0, 0.0)];
    profile.extend(through(&outline, 3));
    profile.push(dvec2(0.0, 0.36));
    let mut s = Surface::turned(&profile, 56, |p, _| p.x);
    let handle = half_ring(0.17, 0.03, 24, 12);
    for side in [0.0, PI] {
        let place = DAffine3::from_rotation_y(side)
            * DAffine3::from_translation(dvec3(0.34, 0.97, 0.0))
            * DAffine3::from_rotation_z(-0.5 * PI);
        s.add(&handle, place);
    }
    s.finish("urn", 50.0)
}

/// A smooth curve through the points, `steps` pieces between each two (Catmull and Rom 1974).
fn through(points: &[DVec2], steps: u32) -> Vec<DVec2> {
    let at = |i: usize| points[i.clamp(1, points.len()) - 1];
    let mut curve = vec![points[0]];
    for i in 1..points.len() {
        let [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        curve.extend((1..=steps).map(|k| {
            let t = f64::from(k) / f64::from(steps);
            let line = b + 0.5 * t * (c - a);
            line + t * t * (a - 2.5 * b + 2.0 * c - 0.5 * d)
                + t * t * t * (1.5 * (b - c) + 0.5 * (d - a))
        }));
    }
    curve
}
