//! The Utah teapot, from its bicubic Bézier patches (Newell 1975; the control points as in Crow,
//! "The origins of the teapot", 1987): an open mesh of parts that run through one another.

use shadows::glam::{Affine3A, DVec3, Vec3, Vec4, dvec3, vec3};

use super::{Camera, Light, Mesh, Object, Scene, Sky, square};

/// Pieces along each side of a patch.
const PIECES: u32 = 16;

/// A row of four control points of a quarter turn about the teapot's axis: radius, offset of the
/// two inner points (0.56 of the radius, rounded as published), height.
type Turned = [f64; 3];

/// Rim, body and bottom: four patches from the rim downwards, neighbours share a row.
const BODY: [Turned; 13] = [
    [1.4, 0.784, 2.4],
    [1.3375, 0.749, 2.53125],
    [1.4375, 0.805, 2.53125],
    [1.5, 0.84, 2.4],
    [1.75, 0.98, 1.875],
    [2.0, 1.12, 1.35],
    [2.0, 1.12, 0.9],
    [2.0, 1.12, 0.45],
    [1.5, 0.84, 0.225],
    [1.5, 0.84, 0.15],
    [1.5, 0.84, 0.075],
    [1.425, 0.798, 0.0],
    [0.0, 0.0, 0.0],
];

/// Knob and lid: two patches downwards.
const LID: [Turned; 7] = [
    [0.0, 0.0, 3.15],
    [0.8, 0.45, 3.15],
    [0.0, 0.0, 2.85],
    [0.2, 0.112, 2.7],
    [0.4, 0.224, 2.55],
    [1.3, 0.728, 2.55],
    [1.3, 0.728, 2.4],
];

/// A row of four control points of one half of a tube: inner x and height, outer x and height, half
/// width. The first and last point lie in the plane of symmetry.
type Tube = [f64; 5];

/// Two patches from the rim round to the body.
const HANDLE: [Tube; 7] = [
    [-1.6, 2.025, -1.5, 2.25, 0.3],
    [-2.3, 2.025, -2.5, 2.25, 0.3],
    [-2.7, 2.025, -3.0, 2.25, 0.3],
    [-2.7, 1.8, -3.0, 1.8, 0.3],
    [-2.7, 1.575, -3.0, 1.35, 0.3],
    [-2.5, 1.125, -2.65, 0.9375, 0.3],
    [-2.0, 0.9, -1.9, 0.6, 0.3],
];

/// Two patches from the body out to the tip, and a little back into it.
const SPOUT: [Tube; 7] = [
    [1.7, 1.425, 1.7, 0.6, 0.66],
    [2.6, 1.425, 3.1, 0.825, 0.66],
    [2.3, 2.1, 2.4, 2.025, 0.25],
    [2.7, 2.4, 3.3, 2.4, 0.25],
    [2.8, 2.475, 3.525, 2.49375, 0.25],
    [2.9, 2.475, 3.45, 2.5125, 0.15],
    [2.8, 2.4, 3.2, 2.4, 0.15],
];

/// The teapot, 3.15 m high in its published units, on a square that only receives.
pub fn teapot() -> Scene {
    let object = |name: &str, mesh, casts, albedo| Object {
        name: name.into(),
        mesh,
        transform: Affine3A::IDENTITY,
        casts,
        albedo,
        glow: [0.0; 3],
    };
    Scene {
        name: "teapot".into(),
        meshes: vec![square("ground", Vec3::ZERO, 12.0), teapot_mesh(PIECES)],
        objects: vec![
            object("ground", 0, false, [0.55, 0.54, 0.52]),
            object("teapot", 1, true, [0.7, 0.62, 0.5]),
        ],
        lights: vec![Light::new(Vec4::new(3.37, 6.61, 2.83, 1.0), 30.0)],
        sky: Sky::default(),
        camera: Camera {
            eye: vec3(-2.3, 4.9, 8.9),
            target: vec3(-0.2, 0.9, -0.3),
            fovy: std::f32::consts::FRAC_PI_4,
            near: 0.1,
        },
        left_out: Vec::new(),
    }
}

/// 32 patches of `pieces` x `pieces` quads, Y up, spout along +x, foot at the origin. Triangles at
/// the two poles that would have no area are left out.
pub fn teapot_mesh(pieces: u32) -> Mesh {
    let mut mesh = Mesh {
        name: "teapot".into(),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    for patch in patches() {
        patch.tessellate(pieces, &mut mesh);
    }
    mesh
}

/// All 32 patches, in the published frame (Z up): each part with its mirror images.
fn patches() -> Vec<Patch> {
    let mut all = Vec::with_capacity(32);
    for rows in BODY.windows(4).step_by(3).chain(LID.windows(4).step_by(3)) {
        let rows: Vec<_> = rows.iter().map(turned_row).collect();
        for [x, y] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
            all.push(Patch::mirrored(&rows, dvec3(x, y, 1.0)));
        }
    }
    for rows in HANDLE
        .windows(4)
        .step_by(3)
        .chain(SPOUT.windows(4).step_by(3))
    {
        let rows: Vec<_> = rows.iter().map(tube_row).collect();
        for y in [1.0, -1.0] {
            all.push(Patch::mirrored(&rows, dvec3(1.0, y, 1.0)));
        }
    }
    all
}

fn turned_row(&[r, k, z]: &Turned) -> [DVec3; 4] {
    [
        dvec3(r, 0.0, z),
        dvec3(r, -k, z),
        dvec3(k, -r, z),
        dvec3(0.0, -r, z),
    ]
}

fn tube_row(&[x, z, x_out, z_out, half]: &Tube) -> [DVec3; 4] {
    [
        dvec3(x, 0.0, z),
        dvec3(x, -half, z),
        dvec3(x_out, -half, z_out),
        dvec3(x_out, 0.0, z_out),
    ]
}

/// A bicubic Bézier patch: `rows[i][j]` weighs B_i(v) B_j(u).
struct Patch {
    rows: [[DVec3; 4]; 4],
    /// Whether the mirror image turned it inside out.
    flipped: bool,
}

impl Patch {
    fn mirrored(rows: &[[DVec3; 4]], mirror: DVec3) -> Self {
        Self {
            rows: std::array::from_fn(|i| rows[i].map(|p| p * mirror)),
            flipped: mirror.element_product() < 0.0,
        }
    }

    /// Weighs the control points along v and along u.
    fn sum(&self, v: [f64; 4], u: [f64; 4]) -> DVec3 {
        let row = |i: usize| (0..4).map(|j| self.rows[i][j] * u[j]).sum::<DVec3>();
        (0..4).map(|i| row(i) * v[i]).sum()
    }

    /// Outward unit normal. Where a whole row falls into a pole, the derivative along u vanishes
    /// and its first derivative along v, pointing away from the pole, takes its place.
    fn normal(&self, v: f64, u: f64) -> DVec3 {
        let across = self.sum(slopes(v), weights(u));
        let pole = (v == 0.0 && same(&self.rows[0])) || (v == 1.0 && same(&self.rows[3]));
        let along = if pole {
            let inwards = if v == 0.0 { 1.0 } else { -1.0 };
            self.sum(slopes(v), slopes(u)) * inwards
        } else {
            self.sum(weights(v), slopes(u))
        };
        let sign = if self.flipped { -1.0 } else { 1.0 };
        along.cross(across).normalize_or_zero() * sign
    }

    fn tessellate(&self, pieces: u32, mesh: &mut Mesh) {
        let first = mesh.positions.len() as u32;
        let part = |i: u32| f64::from(i) / f64::from(pieces);
        for (i, j) in (0..=pieces).flat_map(|i| (0..=pieces).map(move |j| (i, j))) {
            let (v, u) = (part(i), part(j));
            let point = upright(self.sum(weights(v), weights(u)));
            mesh.positions.push(point.as_vec3().to_array());
            let normal = upright(self.normal(v, u));
            mesh.normals.push(normal.as_vec3().to_array());
        }
        let at = |i: u32, j: u32| first + i * (pieces + 1) + j;
        for (i, j) in (0..pieces).flat_map(|i| (0..pieces).map(move |j| (i, j))) {
            let [a, b] = [at(i, j), at(i, j + 1)];
            let [c, d] = [at(i + 1, j), at(i + 1, j + 1)];
            for t in [[a, b, d], [a, d, c]] {
                push_triangle(mesh, if self.flipped { [t[0], t[2], t[1]] } else { t });
            }
        }
    }
}

/// Y up from the published Z up; adding zero turns -0 into 0, so mirrored seams are bit-equal.
fn upright(p: DVec3) -> DVec3 {
    dvec3(p.x, p.z, -p.y) + DVec3::ZERO
}

fn push_triangle(mesh: &mut Mesh, t: [u32; 3]) {
    let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
    if a != b && b != c && c != a {
        mesh.indices.extend(t);
    }
}

fn same(row: &[DVec3; 4]) -> bool {
    row.iter().all(|p| *p == row[0])
}

/// The cubic Bernstein polynomials.
fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [
        -3.0 * s * s,
        3.0 * s * (s - 2.0 * t),
        3.0 * t * (2.0 * s - t),
        3.0 * t * t,
    ]
}
