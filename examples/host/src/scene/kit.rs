//! What city and valley are built from: prisms, tubes, lumps, all closed, and turns. Metres.

use std::f64::consts::TAU;

use shadows::glam::{DAffine3, DQuat, DVec2, DVec3, Quat, Vec2, dvec3};

use super::surface::Surface;

/// A turn about y, in radians. Sines of f32 differ from platform to platform in their last bit, and so do
/// products of quaternions; f64's are the same once they are rounded to f32.
pub fn about_y(angle: f32) -> Quat {
    DQuat::from_rotation_y(angle.into()).as_quat()
}

/// The direction at an angle from x, in radians; see [`about_y`].
pub fn direction(angle: f32) -> Vec2 {
    DVec2::from_angle(angle.into()).as_vec2()
}

/// The turn of [`about_y`] before +y is laid into a direction, of length 1.
pub fn leaning(up: DVec3, angle: f32) -> Quat {
    (DQuat::from_rotation_arc(DVec3::Y, up) * DQuat::from_rotation_y(angle.into())).as_quat()
}

impl Surface {
    /// Adds a closed box.
    pub fn block(&mut self, min: DVec3, max: DVec3) {
        self.add(&Self::cuboid(min, max), DAffine3::IDENTITY);
    }

    /// Adds a closed straight bar with a round section.
    pub fn rod(&mut self, from: DVec3, to: DVec3, radius: f64, sectors: u32) {
        self.add(&Self::bar(from, to, radius, sectors), DAffine3::IDENTITY);
    }

    /// A closed prism along x: a convex outline of (z, y), counter-clockwise seen from -x.
    pub fn prism(outline: &[DVec2], x: [f64; 2]) -> Self {
        let n = outline.len() as u32;
        let fan: Vec<[u32; 3]> = (2..n).map(|i| [0, i - 1, i]).collect();
        // Built along z and turned by a quarter: (x, y, z) goes to (-z, y, x).
        let plate = Self::plate(outline, &fan, (-x[1], -x[0]));
        let mut turned = Self::default();
        turned.add(&plate, DAffine3::from_rotation_y(-0.25 * TAU));
        turned
    }

    /// A closed round tube along a path, of a radius at each point. `sectors` at least 3.
    pub fn tube(path: &[DVec3], radius: impl Fn(usize) -> f64, sectors: u32) -> Self {
        let last = path.len() - 1;
        let along = |i: usize| (path[(i + 1).min(last)] - path[i.max(1) - 1]).normalize();
        // Carried along without a twist.
        let mut side = along(0).any_orthonormal_vector();
        Self::swept((0..=last).map(|i| {
            let way = along(i);
            side = (side - way * side.dot(way)).normalize();
            let up = way.cross(side);
            let row = (0..sectors).map(|k| {
                let (sine, cosine) = (TAU * f64::from(k) / f64::from(sectors)).sin_cos();
                path[i] + radius(i) * (cosine * side - sine * up)
            });
            (path[i], row.collect())
        }))
    }

    /// A wire of this radius that hangs `sag` below the straight line in the middle.
    pub fn wire(from: DVec3, to: DVec3, sag: f64, radius: f64, pieces: u32) -> Self {
        let at = |t: f64| from.lerp(to, t) - DVec3::Y * (4.0 * sag * t * (1.0 - t));
        let path: Vec<DVec3> = (0..=pieces)
            .map(|i| at(f64::from(i) / f64::from(pieces)))
            .collect();
        Self::tube(&path, |_| radius, 5)
    }

    /// A lumpy ball: an icosahedron divided `times`, its corners moved along their directions to
    /// where `radius` says.
    pub fn lump(times: u32, radius: impl Fn(DVec3) -> f64) -> Self {
        let mut s = icosahedron();
        for _ in 0..times {
            s = divided(&s);
        }
        for p in &mut s.positions {
            let direction = p.normalize();
            *p = direction * radius(direction);
        }
        s
    }

    /// The surface scaled and moved.
    pub fn placed(&self, transform: DAffine3) -> Self {
        let mut s = Self::default();
        s.add(self, transform);
        s
    }
}

fn icosahedron() -> Surface {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut s = Surface::default();
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        s.corner(dvec3(a, b, 0.0));
    }
    for (a, b) in [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ] {
        s.corner(dvec3(0.0, a, b));
    }
    for (a, b) in [
        (golden, -1.0),
        (golden, 1.0),
        (-golden, -1.0),
        (-golden, 1.0),
    ] {
        s.corner(dvec3(a, 0.0, b));
    }
    s.triangles = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ]
    .to_vec();
    s
}

/// Each triangle in four.
fn divided(s: &Surface) -> Surface {
    let mut out = Surface {
        positions: s.positions.clone(),
        triangles: Vec::new(),
    };
    let mut middles = std::collections::HashMap::new();
    for &[a, b, c] in &s.triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                let [p, q] = [p, q].map(|i| s.positions[i as usize]);
                out.positions.push(0.5 * (p + q));
                out.positions.len() as u32 - 1
            })
        });
        out.triangles
            .extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    out
}
