//! Meshes, cameras and analytic answers.

use std::f32::consts::PI;

use shadows::glam::{DAffine3, DVec3, Mat4, Vec2, Vec3, Vec4};
use shadows::reference::{Class, ReferenceImage, ReferenceObject, ReferenceScene};
use shadows::{DepthConvention, HomogeneousLight, View};

pub const SIDE: u32 = 160;

#[derive(Clone)]
pub struct Mesh {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
}

impl Mesh {
    pub fn object(&self, casts: bool) -> ReferenceObject<'_> {
        ReferenceObject {
            positions: &self.positions,
            indices: &self.indices,
            transform: DAffine3::IDENTITY,
            casts,
        }
    }

    pub fn at(&self, transform: DAffine3, casts: bool) -> ReferenceObject<'_> {
        ReferenceObject {
            transform,
            ..self.object(casts)
        }
    }
}

/// A horizontal rectangle, counter-clockwise from above.
pub fn rectangle(low: Vec2, high: Vec2, y: f32) -> Mesh {
    Mesh {
        positions: vec![
            [low.x, y, low.y],
            [low.x, y, high.y],
            [high.x, y, high.y],
            [high.x, y, low.y],
        ],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

pub fn ground() -> Mesh {
    rectangle(Vec2::splat(-20.0), Vec2::splat(20.0), 0.0)
}

/// A closed box of eight vertices.
pub fn cuboid(low: Vec3, high: Vec3) -> Mesh {
    let corner = |i: usize| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        [pick(0), pick(1), pick(2)]
    };
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    Mesh {
        positions: (0..8).map(corner).collect(),
        indices: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [a, b, c, a, c, d])
            .collect(),
    }
}

/// A sphere of `rings` between two poles and `sectors` around.
pub fn sphere(centre: Vec3, radius: f32, rings: u32, sectors: u32) -> Mesh {
    let mut positions = vec![(centre + Vec3::Y * radius).to_array()];
    for ring in 1..=rings {
        let phi = PI * ring as f32 / (rings + 1) as f32;
        for sector in 0..sectors {
            let t = 2.0 * PI * sector as f32 / sectors as f32;
            let unit = Vec3::new(phi.sin() * t.cos(), phi.cos(), phi.sin() * t.sin());
            positions.push((centre + radius * unit).to_array());
        }
    }
    positions.push((centre - Vec3::Y * radius).to_array());
    let vertex = |ring: u32, sector: u32| 1 + (ring - 1) * sectors + sector % sectors;
    let bottom = positions.len() as u32 - 1;
    let mut indices = Vec::new();
    for k in 0..sectors {
        indices.extend([0, vertex(1, k + 1), vertex(1, k)]);
        indices.extend([bottom, vertex(rings, k), vertex(rings, k + 1)]);
        for j in 1..rings {
            let (a, b) = (vertex(j, k), vertex(j, k + 1));
            let (c, d) = (vertex(j + 1, k), vertex(j + 1, k + 1));
            indices.extend([a, b, c, b, d, c]);
        }
    }
    Mesh { positions, indices }
}

/// Straight down from `eye`, 90 degrees wide and high; every entry is exact. World -Z is up.
pub fn downward(eye: Vec3, near: f32) -> View {
    let matrix = Mat4::from_cols(
        Vec4::new(1.0, 0.0, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, -1.0, 0.0, 0.0),
        Vec4::new(-eye.x, eye.z, near, eye.y),
    );
    View::new(matrix, DepthConvention::InfiniteReverse).unwrap()
}

/// The ground point under a pixel of [`downward`].
pub fn ground_under(x: u32, y: u32, eye: Vec3) -> DVec3 {
    let clip = |i: u32| (2.0 * f64::from(i) + 1.0) / f64::from(SIDE) - 1.0;
    let eye = eye.as_dvec3();
    DVec3::new(eye.x + clip(x) * eye.y, 0.0, eye.z + clip(y) * eye.y)
}

/// Whether the open segment from `from` to the light passes through the box.
pub fn crosses(from: DVec3, light: HomogeneousLight, low: DVec3, high: DVec3) -> bool {
    let light = light.xyzw().as_dvec4();
    let to = light.truncate() - light.w * from;
    let (mut near, mut far) = (0.0, if light.w == 1.0 { 1.0 } else { f64::INFINITY });
    for axis in 0..3 {
        let (a, b) = (
            (low[axis] - from[axis]) / to[axis],
            (high[axis] - from[axis]) / to[axis],
        );
        near = f64::max(near, a.min(b));
        far = f64::min(far, a.max(b));
    }
    near < far
}

/// Number of pixels whose class is not what `expected` says; `None` says nothing.
pub fn disagreements(
    image: &ReferenceImage,
    expected: impl Fn(u32, u32) -> Option<Class>,
) -> (usize, usize) {
    let mut said = 0;
    let wrong = image
        .classes()
        .enumerate()
        .filter(|&(i, class)| {
            let (x, y) = (i as u32 % image.width(), i as u32 / image.width());
            let expected = expected(x, y);
            said += usize::from(expected.is_some());
            expected.is_some_and(|expected| expected != class)
        })
        .count();
    (wrong, said)
}

pub fn lit_or(shadow: bool) -> Class {
    if shadow { Class::Shadowed } else { Class::Lit }
}

/// Exact in f32 also when 1e5 is added, and no pixel centre falls on an edge of the scenes below.
pub const EYE: Vec3 = Vec3::new(0.2578125, 8.0, 0.5);

pub fn from_above(objects: &[ReferenceObject<'_>], light: HomogeneousLight) -> ReferenceImage {
    let scene = ReferenceScene::new(objects).unwrap();
    scene
        .render(&downward(EYE, 0.1), SIDE, SIDE, light, None)
        .unwrap()
}

/// Ground, a box that rests on it, another above, a coplanar copy of the ground, and a sphere.
pub fn furnished() -> [Mesh; 5] {
    [
        ground(),
        cuboid(Vec3::new(-2.0, 0.0, -1.0), Vec3::new(-1.0, 1.0, 0.5)),
        cuboid(Vec3::new(1.0, 1.5, -1.0), Vec3::new(2.5, 2.0, 0.5)),
        ground(),
        sphere(Vec3::new(0.0, 1.0, 2.0), 0.75, 12, 16),
    ]
}
