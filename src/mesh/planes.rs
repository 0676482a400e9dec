//! The planes of a mesh's triangles, by which most of them say at once on which side a light lies.
//!
//! A plane stands for its triangle only where it is beyond doubt: [`FacingLight`] bounds what its
//! rounding, and that of the rule it stands for, can amount to for one light, and leaves the others
//! to the rule itself. So no sign differs from the rule's, and no triangle's corners are read but
//! those seen edge-on.

use glam::{DVec3, Vec3, Vec4, Vec4Swizzles as _};

use super::data::MeshData;

/// Triangles in a word of facings.
pub(crate) const LANES: usize = 64;

/// x, y, z of the scaled normals and the constant terms of 64 triangles.
type Planes = [[f32; LANES]; 4];

/// A triangle's normal `(b - a) x (c - a)` over the sum of the magnitudes of its six products, and
/// the constant term that goes with it, counted from the middle of the mesh.
///
/// A normal of zeros (a sliver along an axis, or padding) leaves every light in doubt.
#[derive(Clone, Debug)]
pub(crate) struct TrianglePlanes {
    words: Vec<Planes>,
    centre: DVec3,
    /// How far a corner is from the centre along any axis.
    reach: f64,
}

/// A light, ready to be held against planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacingLight {
    light: [f32; 4],
    /// What is nearer to 0 than this says nothing.
    doubt: f32,
}

/// On which side of 64 triangles the light certainly is, a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Facings {
    pub front: u64,
    pub back: u64,
}

impl TrianglePlanes {
    pub fn new(mesh: &MeshData) -> Self {
        let corners = || mesh.positions.iter().map(|&p| Vec3::from(p).as_dvec3());
        let least = corners().fold(DVec3::INFINITY, DVec3::min);
        let most = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (centre, reach) = match mesh.positions.is_empty() {
            true => (DVec3::ZERO, 0.0),
            false => ((least + most) * 0.5, (most - least).max_element() * 0.5),
        };
        let mut words = vec![[[0.0; LANES]; 4]; mesh.triangles.len().div_ceil(LANES)];
        for (word, triangles) in words.iter_mut().zip(mesh.triangles.chunks(LANES)) {
            for (lane, corners) in triangles.iter().enumerate() {
                let plane = plane(
                    corners.map(|v| Vec3::from(mesh.positions[v as usize]).as_dvec3() - centre),
                );
                for (row, value) in word.iter_mut().zip(plane) {
                    row[lane] = value;
                }
            }
        }
        Self {
            words,
            centre,
            reach,
        }
    }

    /// A homogeneous light in the mesh's own space, and what xyz lost when rounded to f32.
    ///
    /// With u = 2^-24 and M the largest component of light - w p over the mesh's box, and twice the
    /// rest: a plane's four terms add up to no more than M and carry no more than 6 u each (normal,
    /// light, product, three sums). The rule decides wherever the determinant is beyond twice its
    /// bound of 10 u times the permanent, which is M at most in this scale. 32 u M holds all of it.
    pub fn light(&self, light: Vec4, rest: Vec3) -> FacingLight {
        // Below, what underflows would count.
        const SMALLEST: f64 = 1e-30;
        let w = f64::from(light.w);
        let rest = rest.as_dvec3();
        let from_centre = light.xyz().as_dvec3() + rest - w * self.centre;
        let largest =
            from_centre.abs().max_element() + w.abs() * self.reach + 2.0 * rest.abs().max_element();
        let doubt = match largest > SMALLEST {
            true => (largest * (32.0 / 16_777_216.0)) as f32,
            false => f32::INFINITY,
        };
        FacingLight {
            light: from_centre.as_vec3().extend(light.w).to_array(),
            doubt,
        }
    }

    /// The facings of all triangles, 64 at a time; bits beyond the last triangle are 0.
    pub fn facings(&self, light: FacingLight) -> impl Iterator<Item = Facings> {
        self.words.iter().map(move |planes| light.side_of(planes))
    }
}

/// Everything relative to the centre.
fn plane([a, b, c]: [DVec3; 3]) -> [f32; 4] {
    /// Relative to the edges; thinner than this, f32 products of their components may underflow.
    const THINNEST: f64 = 1e-15;
    let (u, v) = (b - a, c - a);
    let p = DVec3::new(u.y * v.z, u.z * v.x, u.x * v.y);
    let q = DVec3::new(u.z * v.y, u.x * v.z, u.y * v.x);
    let sum = (p.abs() + q.abs()).element_sum();
    let thinnest = u.abs().max_element() * v.abs().max_element() * THINNEST;
    // Also false where a mesh is so small or large that f64 products are no longer sound.
    if !(sum > thinnest && sum.is_normal()) {
        return [0.0; 4];
    }
    let normal = (p - q) / sum;
    normal.extend(-normal.dot(a)).as_vec4().to_array()
}

impl FacingLight {
    /// Without any doubt, for tests to see what it is good for.
    #[cfg(test)]
    pub fn rash(self) -> Self {
        Self { doubt: 0.0, ..self }
    }

    fn side_of(self, planes: &Planes) -> Facings {
        let [x, y, z, w] = self.light;
        let [nx, ny, nz, d] = planes;
        let (mut front, mut back) = ([0_u8; LANES], [0_u8; LANES]);
        for i in 0..LANES {
            let side = ((nx[i] * x + ny[i] * y) + nz[i] * z) + d[i] * w;
            front[i] = u8::from(side > self.doubt);
            back[i] = u8::from(side < -self.doubt);
        }
        Facings {
            front: bits(&front),
            back: bits(&back),
        }
    }
}

/// Bytes of 0 and 1 as bits.
fn bits(bytes: &[u8; LANES]) -> u64 {
    // Moves bit 8 i to bit 56 + i.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let (eights, _) = bytes.as_chunks::<8>();
    let byte = |eight: &[u8; 8]| u64::from_le_bytes(*eight).wrapping_mul(GATHER) >> 56;
    let places = eights.iter().zip((0..).step_by(8));
    places.fold(0, |word, (eight, place)| word | byte(eight) << place)
}
