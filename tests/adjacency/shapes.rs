//! Meshes to test with.

use std::f32::consts::TAU;

/// Positions and triangles.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

/// A small generator of random numbers (Vigna's splitmix64, 2015): the same seed, the same mesh.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }
}

impl Mesh {
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    pub fn flip(&mut self, triangle: usize) {
        self.indices.swap(3 * triangle + 1, 3 * triangle + 2);
    }

    pub fn remove(&mut self, triangle: usize) {
        self.indices.drain(3 * triangle..3 * triangle + 3);
    }

    /// Triangles in random order, each starting from a random corner, and some corners with
    /// vertices of their own: the same surface.
    pub fn scramble(&mut self, random: &mut Random) {
        let count = self.triangle_count();
        for last in (1..count).rev() {
            let other = random.below(last + 1);
            for corner in 0..3 {
                self.indices.swap(3 * last + corner, 3 * other + corner);
            }
        }
        for triangle in self.indices.chunks_exact_mut(3) {
            triangle.rotate_left(random.below(3));
        }
        for place in 0..self.indices.len() {
            if random.below(4) == 0 {
                let position = self.positions[self.indices[place] as usize];
                self.indices[place] = self.positions.len() as u32;
                self.positions.push(position);
            }
        }
    }
}

/// A closed torus of `2 * rings * sectors` triangles.
pub fn torus(rings: u32, sectors: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |r: u32, s: u32| (r % rings) * sectors + s % sectors;
    for ring in 0..rings {
        for sector in 0..sectors {
            let (sr, cr) = (ring as f32 / rings as f32 * TAU).sin_cos();
            let (ss, cs) = (sector as f32 / sectors as f32 * TAU).sin_cos();
            mesh.positions.push([(3.0 + cs) * cr, ss, (3.0 + cs) * sr]);
            let (a, b) = (at(ring, sector), at(ring, sector + 1));
            let (c, d) = (at(ring + 1, sector), at(ring + 1, sector + 1));
            mesh.indices.extend([a, b, c, b, d, c]);
        }
    }
    mesh
}

/// A closed sphere grown from a tetrahedron by splitting random triangles into three: vertices of
/// any degree.
pub fn stacked_sphere(splits: usize, random: &mut Random) -> Mesh {
    let mut mesh = Mesh {
        positions: vec![[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]],
        indices: vec![0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2],
    };
    for _ in 0..splits {
        let first = 3 * random.below(mesh.triangle_count());
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.indices[first + corner]);
        let top = mesh.positions.len() as u32;
        mesh.positions.push([(); 3].map(|()| random.signed()));
        mesh.indices[first + 2] = top;
        mesh.indices.extend([b, c, top, c, a, top]);
    }
    mesh
}

/// Any triangles over a few lattice points: repeated vertices, repeated triangles, collapsed ones,
/// edges of many triangles, unused vertices.
pub fn soup(vertices: usize, triangles: usize, side: usize, random: &mut Random) -> Mesh {
    Mesh {
        positions: (0..vertices)
            .map(|_| [(); 3].map(|()| random.below(side) as f32))
            .collect(),
        indices: (0..3 * triangles)
            .map(|_| random.below(vertices) as u32)
            .collect(),
    }
}

/// The unit cube of eight vertices, at the origin.
pub fn cube() -> Mesh {
    let positions = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|bit| bit as f32));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    Mesh {
        positions: positions.collect(),
        indices: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
            .collect(),
    }
}

/// The same cube with four vertices a side, and every other zero negative.
pub fn cube_of_24() -> Mesh {
    let cube = cube();
    let mut mesh = Mesh::default();
    for (side, corners) in cube.indices.chunks_exact(6).enumerate() {
        let sign = if side % 2 == 0 { 1.0 } else { -1.0 };
        for corner in [0, 1, 2, 5] {
            let position = cube.positions[corners[corner] as usize];
            mesh.positions
                .push(position.map(|x| if x == 0.0 { x * sign } else { x }));
        }
        let first = 4 * side as u32;
        mesh.indices
            .extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    mesh
}

/// A band of quads closed to a ring, its end turned over if `twisted` (August Moebius's strip).
pub fn band(quads: u32, twisted: bool) -> Mesh {
    let mut mesh = Mesh::default();
    for quad in 0..quads {
        let turn = quad as f32 / quads as f32;
        let (s, c) = (turn * TAU).sin_cos();
        let (hs, hc) = if twisted {
            (turn * TAU / 2.0).sin_cos()
        } else {
            (0.0, 1.0)
        };
        for side in [-1.0, 1.0] {
            let radius = 3.0 + side * hs;
            mesh.positions.push([radius * c, side * hc, radius * s]);
        }
        let (a, b) = (2 * quad, 2 * quad + 1);
        let (c, d) = match (quad + 1 == quads, twisted) {
            (false, _) => (a + 2, b + 2),
            (true, false) => (0, 1),
            (true, true) => (1, 0),
        };
        mesh.indices.extend([a, b, c, b, d, c]);
    }
    mesh
}

/// Fins around one edge: vertices 0 and 1, and one more for each.
pub fn fins(count: u32, alternate: bool) -> Mesh {
    let mut mesh = Mesh {
        positions: vec![[0., 0., 0.], [0., 0., 1.]],
        indices: Vec::new(),
    };
    for fin in 0..count {
        let (s, c) = (fin as f32 / count as f32 * TAU).sin_cos();
        mesh.positions.push([c, s, fin as f32]);
        let (a, b) = if alternate && fin % 2 == 1 {
            (1, 0)
        } else {
            (0, 1)
        };
        mesh.indices.extend([a, b, fin + 2]);
    }
    mesh
}
