//! The walls of a house: one closed surface with a niche for each window and door.

use shadows::glam::{DVec3, dvec3};

use super::super::surface::Surface;

/// The openings of a storey in one face, left to right seen from outside, as x from the middle.
pub type Openings = Vec<[f64; 2]>;

/// A storey's openings lie between two heights.
#[derive(Clone, Debug)]
pub struct Storey {
    pub y: [f64; 2],
    /// Front, right, back, left: as one walks around counter-clockwise seen from above.
    pub faces: [Openings; 4],
}

/// Width along x, height, depth along z; around the origin's y axis, standing on y = 0, the front
/// towards +z.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub width: f64,
    pub height: f64,
    pub depth: f64,
}

impl Body {
    /// From a face's own space (x to the right seen from outside, z outward, the wall at z = 0).
    pub fn place(&self, face: usize, p: DVec3) -> DVec3 {
        let (x, y, z) = (p.x, p.y, p.z);
        let [w, d] = [0.5 * self.width, 0.5 * self.depth];
        match face {
            0 => dvec3(x, y, d + z),
            1 => dvec3(w + z, y, -x),
            2 => dvec3(-x, y, -d - z),
            _ => dvec3(-w - z, y, x),
        }
    }

    /// Half of how wide a face is.
    pub fn half(&self, face: usize) -> f64 {
        0.5 * if face.is_multiple_of(2) {
            self.width
        } else {
            self.depth
        }
    }
}

/// How deep windows lie in the wall.
pub const NICHE: f64 = 0.22;

/// The walls, closed below and above.
pub fn walls(body: &Body, storeys: &[Storey]) -> Surface {
    let mut s = Surface::default();
    let heights: Vec<f64> = std::iter::once(0.0)
        .chain(storeys.iter().flat_map(|storey| storey.y))
        .chain([body.height])
        .collect();
    // The four vertical edges, each on the left of its face.
    let edges: [Vec<u32>; 4] = std::array::from_fn(|face| {
        let x = -body.half(face);
        let corner = |y: &f64| s.corner(body.place(face, dvec3(x, *y, 0.0)));
        heights.iter().map(corner).collect()
    });
    for face in 0..4 {
        let (left, right) = (&edges[face], &edges[(face + 1) % 4]);
        let mut below = vec![left[0], right[0]];
        for (at, storey) in storeys.iter().enumerate() {
            let row = |s: &mut Surface, edge: usize| -> Vec<u32> {
                let y = heights[edge];
                let breaks = storey.faces[face].iter().flatten();
                let mut row = vec![left[edge]];
                row.extend(breaks.map(|x| s.corner(body.place(face, dvec3(*x, y, 0.0)))));
                row.push(right[edge]);
                row
            };
            let (low, high) = (row(&mut s, 2 * at + 1), row(&mut s, 2 * at + 2));
            strip(&mut s, &below, &low);
            for cell in 0..low.len() - 1 {
                let [a, b, c, d] = [low[cell], low[cell + 1], high[cell + 1], high[cell]];
                match cell % 2 {
                    0 => s.quad([a, b, c, d]),
                    _ => niche(
                        &mut s,
                        [a, b, c, d],
                        body.place(face, DVec3::ZERO) - body.place(face, DVec3::Z * NICHE),
                    ),
                }
            }
            below = high;
        }
        let top = heights.len() - 1;
        strip(&mut s, &below, &[left[top], right[top]]);
    }
    let top = heights.len() - 1;
    s.quad([0, 1, 2, 3].map(|face: usize| edges[face][top]));
    s.quad([3, 2, 1, 0].map(|face: usize| edges[face][0]));
    s
}

/// Triangles between two lines of corners, both from left to right, the second above the first.
fn strip(s: &mut Surface, below: &[u32], above: &[u32]) {
    let part = |s: &Surface, row: &[u32], i: usize| {
        let [first, last, at] = [row[0], row[row.len() - 1], row[i]];
        let [first, last, at] = [first, last, at].map(|k| s.positions[k as usize]);
        at.distance(first) / last.distance(first)
    };
    let (mut i, mut j) = (0, 0);
    while i + 1 < below.len() || j + 1 < above.len() {
        let lower = j + 1 == above.len()
            || (i + 1 < below.len() && part(s, below, i + 1) <= part(s, above, j + 1));
        if lower {
            s.triangles.push([below[i], below[i + 1], above[j]]);
            i += 1;
        } else {
            s.triangles.push([below[i], above[j + 1], above[j]]);
            j += 1;
        }
    }
}

/// An opening with its four reveals and a back.
fn niche(s: &mut Surface, outer: [u32; 4], inward: DVec3) {
    let inner = outer.map(|k| {
        let p = s.positions[k as usize] + inward;
        s.corner(p)
    });
    for k in 0..4 {
        let next = (k + 1) % 4;
        s.quad([outer[k], outer[next], inner[next], inner[k]]);
    }
    s.quad(inner);
}
