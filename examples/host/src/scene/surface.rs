//! A surface being built: shared corners and triangles in f64, then normals with creases.

use std::collections::HashMap;
use std::f64::consts::TAU;

use shadows::glam::{DAffine3, DVec2, DVec3};

use super::Mesh;

/// Corners and triangles. Triangles that meet share their corners, so a closed surface stays closed
/// when it is rounded to f32.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Corners.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Adds a corner and says where it is.
    pub fn corner(&mut self, p: DVec3) -> u32 {
        self.positions.push(p);
        (self.positions.len() - 1) as u32
    }

    /// Adds a planar quadrilateral, counter-clockwise; a corner given twice in a row makes it a triangle.
    pub fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        for t in [[a, b, c], [a, c, d]] {
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                self.triangles.push(t);
            }
        }
    }

    /// Adds another surface, moved; its corners stay its own.
    pub fn add(&mut self, other: &Self, transform: DAffine3) {
        let first = self.positions.len() as u32;
        let moved = other
            .positions
            .iter()
            .map(|p| transform.transform_point3(*p));
        self.positions.extend(moved);
        let mirrored = transform.matrix3.determinant() < 0.0;
        self.triangles.extend(other.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| i + first);
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
    }

    /// A closed box.
    pub fn cuboid(min: DVec3, max: DVec3) -> Self {
        let mut s = Self::default();
        for i in 0..8 {
            let pick = |bit: usize, lo, hi| if i & bit == 0 { lo } else { hi };
            s.corner(DVec3::new(
                pick(1, min.x, max.x),
                pick(2, min.y, max.y),
                pick(4, min.z, max.z),
            ));
        }
        for q in [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ] {
            s.quad(q);
        }
        s
    }

    /// A closed surface of revolution about the Y axis. `profile` holds (radius, height) going up,
    /// first and last on the axis; `radius` may bend a row's radius by the angle in radians.
    pub fn turned(profile: &[DVec2], sectors: u32, radius: impl Fn(DVec2, f64) -> f64) -> Self {
        let mut s = Self::default();
        let mut below: Vec<u32> = Vec::new();
        for p in profile {
            let row: Vec<u32> = if p.x == 0.0 {
                vec![s.corner(DVec3::new(0.0, p.y, 0.0)); sectors as usize]
            } else {
                (0..sectors)
                    .map(|k| {
                        let t = TAU * f64::from(k) / f64::from(sectors);
                        let r = radius(*p, t);
                        s.corner(DVec3::new(r * t.cos(), p.y, r * t.sin()))
                    })
                    .collect()
            };
            s.band(&below, &row);
            below = row;
        }
        s
    }

    /// A closed tube: rows of corners around a path, each with its middle, in order along it. Seen
    /// along the path the rows turn clockwise.
    pub fn swept(rows: impl Iterator<Item = (DVec3, Vec<DVec3>)>) -> Self {
        let mut s = Self::default();
        let mut below: Vec<u32> = Vec::new();
        let mut end = DVec3::ZERO;
        for (middle, row) in rows {
            if below.is_empty() {
                below = vec![s.corner(middle); row.len()];
            }
            let row: Vec<u32> = row.into_iter().map(|p| s.corner(p)).collect();
            s.band(&below, &row);
            below = row;
            end = middle;
        }
        let cap = vec![s.corner(end); below.len()];
        s.band(&below, &cap);
        s
    }

    /// A torus around the Z axis: `radius` to the middle of its section, `section` its radius.
    pub fn ring(radius: f64, section: f64, segments: u32, sectors: u32) -> Self {
        let mut s = Self::default();
        let mut row = |i: u32| -> Vec<u32> {
            let a = TAU * f64::from(i) / f64::from(segments);
            let out = DVec3::new(a.cos(), a.sin(), 0.0);
            let angle = |k| TAU * f64::from(k) / f64::from(sectors);
            (0..sectors)
                .map(|k| angle(k).sin_cos())
                .map(|(z, r)| s.corner(out * (radius + section * r) + DVec3::Z * (section * z)))
                .collect()
        };
        let rows: Vec<Vec<u32>> = (0..segments).map(&mut row).collect();
        for (i, below) in rows.iter().enumerate() {
            s.band(below, &rows[(i + 1) % rows.len()]);
        }
        s
    }

    /// Quads between two closed rows of corners, or nothing where the first is empty.
    fn band(&mut self, below: &[u32], above: &[u32]) {
        for k in 0..below.len() {
            let next = (k + 1) % below.len();
            self.quad([below[k], above[k], above[next], below[next]]);
        }
    }

    /// A closed straight bar with a round section.
    pub fn bar(from: DVec3, to: DVec3, radius: f64, sectors: u32) -> Self {
        let length = from.distance(to);
        let profile = [
            DVec2::new(0.0, 0.0),
            DVec2::new(radius, 0.0),
            DVec2::new(radius, length),
            DVec2::new(0.0, length),
        ];
        let upright = Self::turned(&profile, sectors, |p, _| p.x);
        let turn = shadows::glam::DQuat::from_rotation_arc(DVec3::Y, (to - from) / length);
        let mut s = Self::default();
        s.add(&upright, DAffine3::from_rotation_translation(turn, from));
        s
    }

    /// A closed plate: a flat outline (counter-clockwise seen from +z) with its triangles, given a
    /// thickness from `z.0` to `z.1`.
    pub fn plate(outline: &[DVec2], triangles: &[[u32; 3]], z: (f64, f64)) -> Self {
        let mut s = Self::default();
        for depth in [z.0, z.1] {
            for p in outline {
                s.corner(p.extend(depth));
            }
        }
        let n = outline.len() as u32;
        for t in triangles {
            s.triangles.push([t[0], t[2], t[1]]);
            s.triangles.push(t.map(|i| i + n));
        }
        for i in 0..n {
            let j = (i + 1) % n;
            s.quad([i, j, j + n, i + n]);
        }
        s
    }

    /// Rounds to f32 and computes normals: at each corner of a triangle the angle-weighted mean
    /// (Thürmer and Wüthrich 1998) of the faces around the point that turn away from it by less
    /// than `crease` degrees. Points on a crease are repeated, once per normal.
    pub fn finish(&self, name: &str, crease: f64) -> Mesh {
        let faces: Vec<DVec3> = self
            .triangles
            .iter()
            .map(|t| self.face_normal(*t))
            .collect();
        let around = self.faces_around();
        let limit = crease.to_radians().cos();
        let mut mesh = Mesh {
            name: name.into(),
            positions: Vec::new(),
            normals: Vec::new(),
            indices: Vec::with_capacity(3 * self.triangles.len()),
            mask: Vec::new(),
        };
        let mut seen: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        for (own, t) in faces.iter().zip(&self.triangles) {
            for &corner in t {
                let near = around[corner as usize].iter();
                let near = near.filter(|(f, _)| faces[*f].dot(*own) > limit);
                let sum: DVec3 = near.map(|(f, angle)| faces[*f] * *angle).sum();
                let normal = sum.try_normalize().unwrap_or(*own).as_vec3().to_array();
                let key = (corner, normal.map(f32::to_bits));
                let vertex = *seen.entry(key).or_insert_with(|| {
                    let p = self.positions[corner as usize].as_vec3();
                    mesh.positions.push(p.to_array());
                    mesh.normals.push(normal);
                    (mesh.positions.len() - 1) as u32
                });
                mesh.indices.push(vertex);
            }
        }
        mesh
    }

    /// Unit normal of a triangle; up for one without area.
    fn face_normal(&self, t: [u32; 3]) -> DVec3 {
        let [a, b, c] = t.map(|i| self.positions[i as usize]);
        (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Y)
    }

    /// For each corner, the triangles that use it and their angle there in radians.
    fn faces_around(&self) -> Vec<Vec<(usize, f64)>> {
        let mut around = vec![Vec::new(); self.positions.len()];
        for (f, t) in self.triangles.iter().enumerate() {
            for i in 0..3 {
                let [at, next, last] = [0, 1, 2].map(|k| self.positions[t[(i + k) % 3] as usize]);
                let sides = (next - at)
                    .normalize_or_zero()
                    .dot((last - at).normalize_or_zero());
                around[t[i] as usize].push((f, sides.clamp(-1.0, 1.0).acos()));
            }
        }
        around
    }
}
