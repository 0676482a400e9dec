//! Rays against a handful of triangles in f64, by brute force: what small tests compare with.

use shadows::glam::{Affine3A, DVec3};

/// Triangles in world space.
#[derive(Clone, Default)]
pub struct Triangles(pub Vec<[DVec3; 3]>);

impl Triangles {
    pub fn add(&mut self, positions: &[[f32; 3]], indices: &[u32], transform: Affine3A) {
        let matrix = transform.matrix3;
        let (x, y, z) = (
            matrix.x_axis.as_dvec3(),
            matrix.y_axis.as_dvec3(),
            matrix.z_axis.as_dvec3(),
        );
        let place = |index: u32| {
            let p = positions[index as usize].map(f64::from);
            transform.translation.as_dvec3() + x * p[0] + y * p[1] + z * p[2]
        };
        for t in indices.chunks_exact(3) {
            self.0.push([place(t[0]), place(t[1]), place(t[2])]);
        }
    }

    /// The nearest hit along `origin + t * direction`, t > 0 (Möller and Trumbore, 1997).
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        self.0
            .iter()
            .filter_map(|&[a, b, c]| {
                let (ab, ac) = (b - a, c - a);
                let p = direction.cross(ac);
                let det = ab.dot(p);
                let s = origin - a;
                let u = s.dot(p) / det;
                let q = s.cross(ab);
                let v = direction.dot(q) / det;
                let t = ac.dot(q) / det;
                (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
            })
            .min_by(f64::total_cmp)
    }
}
