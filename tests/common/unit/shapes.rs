//! Meshes to cast shadows with.

use shadows::glam::{Quat, Vec3};

/// Positions and three indices a triangle.
#[derive(Clone, Debug)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

impl Shape {
    fn new(positions: &[[f32; 3]], indices: &[u32]) -> Self {
        Self {
            positions: positions.to_vec(),
            indices: indices.to_vec(),
        }
    }

    /// The same surface seen from the other side.
    pub fn reversed(mut self) -> Self {
        self.indices
            .as_chunks_mut::<3>()
            .0
            .iter_mut()
            .for_each(|t| t.swap(1, 2));
        self
    }

    /// With every triangle turned around whose number `which` picks.
    pub fn turned(mut self, which: impl Fn(usize) -> bool) -> Self {
        for (number, triangle) in self.indices.as_chunks_mut::<3>().0.iter_mut().enumerate() {
            if which(number) {
                triangle.swap(1, 2);
            }
        }
        self
    }

    /// Without the triangles that `keep` does not pick by their corners.
    pub fn cut(mut self, keep: impl Fn([Vec3; 3]) -> bool) -> Self {
        let corner = |i: u32| Vec3::from(self.positions[i as usize]);
        self.indices = self
            .indices
            .as_chunks::<3>()
            .0
            .iter()
            .filter(|t| keep(t.map(corner)))
            .flatten()
            .copied()
            .collect();
        self
    }

    /// Both shapes in one mesh.
    pub fn with(mut self, other: &Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.indices.extend(other.indices.iter().map(|i| i + first));
        self
    }

    /// Turned about an axis that no coordinate axis is near to, so that nothing is axis-aligned.
    pub fn tilted(mut self) -> Self {
        let turn = tilt();
        for position in &mut self.positions {
            *position = (turn * Vec3::from(*position)).to_array();
        }
        self
    }
}

/// The turn of [`Shape::tilted`].
pub fn tilt() -> Quat {
    Quat::from_axis_angle(Vec3::new(1.0, 2.0, 3.0).normalize(), 0.7)
}

/// A horizontal square of half the given side length, wound to be seen from above.
pub fn square(half: f32) -> Shape {
    Shape::new(
        &[
            [-half, 0.0, -half],
            [-half, 0.0, half],
            [half, 0.0, half],
            [half, 0.0, -half],
        ],
        &[0, 1, 2, 0, 2, 3],
    )
}

/// A box from -1 to 1, outward, with four vertices of its own for each face.
pub fn cube() -> Shape {
    let mut shape = Shape::new(&[], &[]);
    for axis in 0..3 {
        for sign in [-1.0f32, 1.0] {
            let first = shape.positions.len() as u32;
            for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let mut corner = [0.0; 3];
                corner[axis] = sign;
                corner[(axis + 1) % 3] = u * sign;
                corner[(axis + 2) % 3] = v;
                shape.positions.push(corner);
            }
            shape.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
        }
    }
    shape
}

/// A unit sphere of `rings` by twice as many quads, outward.
pub fn sphere(rings: u32) -> Shape {
    let columns = 2 * rings;
    let mut shape = Shape::new(&[], &[]);
    for ring in 0..=rings {
        let (y, r) = match ring {
            0 => (1.0, 0.0),
            _ if ring == rings => (-1.0, 0.0),
            _ => {
                let angle = std::f32::consts::PI * ring as f32 / rings as f32;
                (angle.cos(), angle.sin())
            }
        };
        for column in 0..columns {
            let angle = std::f32::consts::TAU * column as f32 / columns as f32;
            shape.positions.push([r * angle.sin(), y, r * angle.cos()]);
        }
    }
    for ring in 0..rings {
        for column in 0..columns {
            let next = (column + 1) % columns;
            let at = |ring: u32, column: u32| ring * columns + column;
            let quad = [
                at(ring, column),
                at(ring + 1, column),
                at(ring + 1, next),
                at(ring, next),
            ];
            // At the poles one of the two has no area; the weld drops it.
            shape
                .indices
                .extend([0, 1, 2, 0, 2, 3].map(|i: usize| quad[i]));
        }
    }
    shape
}

/// An upright tube of `count` strips with slits as wide between them, open above and below.
pub fn slit_tube(radius: f32, half_height: f32, count: u32) -> Shape {
    let mut shape = Shape::new(&[], &[]);
    for strip in 0..count {
        let first = shape.positions.len() as u32;
        for (end, y) in [(0.0, -1.0), (0.5, -1.0), (0.5, 1.0), (0.0, 1.0)] {
            let angle = std::f32::consts::TAU * (strip as f32 + end) / count as f32;
            let (z, x) = angle.sin_cos();
            let corner = [radius * x, half_height * y, radius * z];
            shape.positions.push(corner);
        }
        shape.indices.extend([0, 2, 1, 0, 3, 2].map(|i| first + i));
    }
    shape
}

/// Hills around y = 0: `count` by `count` quads over a square of half the given side length.
pub fn hills(half: f32, count: u32) -> Shape {
    let mut shape = Shape::new(&[], &[]);
    let along = |i: u32| 2.0 * i as f32 / count as f32 - 1.0;
    for row in 0..=count {
        for column in 0..=count {
            let (x, z) = (along(column), along(row));
            let y = 0.012 * ((31.0 * x + 1.3).sin() * (23.0 * z).cos() + (57.0 * (x - z)).sin());
            shape.positions.push([x, y, z].map(|at| half * at));
        }
    }
    for row in 0..count {
        for column in 0..count {
            let first = row * (count + 1) + column;
            let quad = [first, first + count + 1, first + count + 2, first + 1];
            shape
                .indices
                .extend([0, 1, 2, 0, 2, 3].map(|i: usize| quad[i]));
        }
    }
    shape
}

/// `count` vertical fins around one shared edge, like the pages of a book.
pub fn fins(count: u32) -> Shape {
    let mut shape = Shape::new(&[[0.0, 0.0, 0.0], [0.0, 1.5, 0.0]], &[]);
    for fin in 0..count {
        let angle = 0.3 + std::f32::consts::TAU * fin as f32 / count as f32;
        let (z, x) = angle.sin_cos();
        let first = shape.positions.len() as u32;
        shape.positions.extend([[x, 0.0, z], [x, 1.5, z]]);
        // All run through the shared edge in the same direction: no orientation is consistent.
        shape.indices.extend([0, 1, first, first, 1, first + 1]);
    }
    shape
}

/// A closed ring around the y axis: `radius` to the middle of its section, which has that many
/// corners and is repeated twice as often.
pub fn ring(radius: f32, section: f32, corners: u32) -> Shape {
    let count = 2 * corners;
    let mut shape = Shape::new(&[], &[]);
    let angle = |i: u32, n: u32| std::f32::consts::TAU * i as f32 / n as f32;
    for i in 0..count {
        for j in 0..corners {
            let (y, out) = angle(j, corners).sin_cos();
            let (z, x) = angle(i, count).sin_cos();
            let r = radius + section * out;
            shape.positions.push([r * x, section * y, r * z]);
            let at = |i: u32, j: u32| i % count * corners + j % corners;
            let quad = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            shape
                .indices
                .extend([0, 1, 2, 0, 2, 3].map(|k: usize| quad[k]));
        }
    }
    shape
}
