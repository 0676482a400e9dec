//! Small meshes.

use std::f32::consts::{PI, TAU};

use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::{Caster, CasterMesh, wgpu};

#[derive(Clone, Debug)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

impl Shape {
    pub fn mesh(&self, device: &wgpu::Device) -> CasterMesh {
        let adjacency = Adjacency::new(&self.positions, &self.indices).unwrap();
        CasterMesh::new(device, &self.positions, &adjacency).unwrap()
    }

    pub fn caster(&self, device: &wgpu::Device, transform: Affine3A) -> Caster {
        Caster::new(self.mesh(device), transform)
    }
}

/// A closed box with corners at plus and minus `half`, counter-clockwise outside.
pub fn cuboid(half: Vec3) -> Shape {
    let positions = (0..8)
        .map(|i| {
            let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            (half * Vec3::new(sign(1), sign(2), sign(4))).to_array()
        })
        .collect();
    #[rustfmt::skip]
    let indices = vec![
        0, 4, 6, 0, 6, 2, // -x
        1, 3, 7, 1, 7, 5, // +x
        0, 1, 5, 0, 5, 4, // -y
        2, 6, 7, 2, 7, 3, // +y
        0, 2, 3, 0, 3, 1, // -z
        4, 5, 7, 4, 7, 6, // +z
    ];
    Shape { positions, indices }
}

/// A closed sphere of radius 1.
pub fn sphere(rings: u32, sectors: u32) -> Shape {
    let mut positions = vec![[0.0, 1.0, 0.0]];
    for j in 1..=rings {
        let phi = PI * j as f32 / (rings + 1) as f32;
        for k in 0..sectors {
            let t = TAU * k as f32 / sectors as f32;
            positions.push([phi.sin() * t.cos(), phi.cos(), phi.sin() * t.sin()]);
        }
    }
    positions.push([0.0, -1.0, 0.0]);
    let at = |j: u32, k: u32| 1 + (j - 1) * sectors + k % sectors;
    let bottom = 1 + rings * sectors;
    let mut indices = Vec::new();
    for k in 0..sectors {
        indices.extend([0, at(1, k + 1), at(1, k)]);
        indices.extend([bottom, at(rings, k), at(rings, k + 1)]);
        for j in 1..rings {
            let (a, b, c, d) = (at(j, k), at(j, k + 1), at(j + 1, k), at(j + 1, k + 1));
            indices.extend([a, b, c, b, d, c]);
        }
    }
    Shape { positions, indices }
}

/// A square in the plane y = 0 with sides of `2 * half`, seen counter-clockwise from above.
pub fn square(half: f32) -> Shape {
    Shape {
        positions: vec![
            [-half, 0.0, -half],
            [-half, 0.0, half],
            [half, 0.0, half],
            [half, 0.0, -half],
        ],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// Numbers in -1 .. 1 from a fixed seed (PCG, O'Neill 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(2) | 1)
    }

    pub fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let mixed = ((self.0 >> 18) ^ self.0) >> 27;
        let turned = (mixed as u32).rotate_right((self.0 >> 59) as u32);
        (turned >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    pub fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}
