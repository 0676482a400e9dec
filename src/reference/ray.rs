//! A ray or segment in f64, against boxes and triangles.

use glam::DVec3;

/// Where a ray's line meets a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The ray's parameter.
    pub(super) t: f64,
    /// Of the triangle's corners; they add up to 1.
    pub(super) weights: [f64; 3],
}

/// A ray prepared for many intersection tests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    origin: DVec3,
    inverse: DVec3,
    /// Largest parameter that still belongs to the ray.
    end: f64,
    axes: [usize; 3],
    shear: DVec3,
}

impl Ray {
    /// The points `origin + t * direction` with `0 <= t <= end`.
    pub(super) fn new(origin: DVec3, direction: DVec3, end: f64) -> Self {
        let size = direction.abs();
        let major = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let axes = [(major + 1) % 3, (major + 2) % 3, major];
        let along = direction[major];
        Self {
            origin,
            inverse: direction.recip(),
            end,
            axes,
            shear: DVec3::new(
                direction[axes[0]] / along,
                direction[axes[1]] / along,
                1.0 / along,
            ),
        }
    }

    /// Where the ray enters a box, or infinity where it misses.
    ///
    /// The far side is widened by the rounding of the three operations that make it, so that no box
    /// is missed whose content is hit (Ize, "Robust BVH Ray Traversal", 2013).
    pub(super) fn enters(&self, low: [f64; 3], high: [f64; 3], end: f64) -> f64 {
        const WIDER: f64 = 1.0 + 4.0 * f64::EPSILON;
        let (mut near, mut far) = (0.0_f64, self.end.min(end));
        for axis in 0..3 {
            let (low, high) = (
                low[axis] - self.origin[axis],
                high[axis] - self.origin[axis],
            );
            let inverse = self.inverse[axis];
            if inverse.is_finite() {
                let (a, b) = (low * inverse, high * inverse);
                near = near.max(a.min(b));
                far = far.min(a.max(b) * WIDER);
            } else if low > 0.0 || high < 0.0 {
                // Parallel to this slab, and outside it.
                return f64::INFINITY;
            }
        }
        if near <= far { near } else { f64::INFINITY }
    }

    /// The parameter at which the ray's line meets a triangle from either side; edges belong to it.
    ///
    /// The edge functions of two triangles that share an edge are exact negatives of each other, so
    /// no ray slips through between them (Woop, Benthin and Wald, "Watertight Ray/Triangle
    /// Intersection", 2013). `None` also for a triangle seen edge-on.
    pub(super) fn meets(&self, triangle: &[DVec3; 3]) -> Option<Meeting> {
        let [x, y, z] = self.axes;
        let [a, b, c] = triangle.map(|corner| {
            let v = corner - self.origin;
            DVec3::new(
                v[x] - self.shear.x * v[z],
                v[y] - self.shear.y * v[z],
                self.shear.z * v[z],
            )
        });
        let u = c.x * b.y - c.y * b.x;
        let v = a.x * c.y - a.y * c.x;
        let w = b.x * a.y - b.y * a.x;
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let determinant = u + v + w;
        let t = (u * a.z + v * b.z + w * c.z) / determinant;
        t.is_finite().then(|| Meeting {
            t,
            weights: [u, v, w].map(|area| area / determinant),
        })
    }
}
