//! Convex hulls of points near and at infinity, and the proof that a caster misses one.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::view::null_vector;
use crate::volume::decide::world_box::{WorldBox, rounding};

/// What f64 may get wrong in a plane through three points, relative to the terms of its sum.
const ROUNDING: f64 = 1e-12;

/// The convex hull of homogeneous points (`w = 1`) and directions (`w = 0`), as the half-spaces
/// `n . p <= 0` that hold all of it. Without any, the hull is the whole space.
#[derive(Clone, Debug)]
pub(crate) struct Hull {
    planes: Vec<DVec4>,
}

impl Hull {
    /// Every plane through three of the points that has all the others on one side, and the planes
    /// of the axis-aligned box around them. Meant for the ten points at most of a frame.
    pub fn new(points: &[DVec4]) -> Self {
        let magnitude = points.iter().filter(|p| p.w != 0.0);
        let magnitude = magnitude.fold(DVec3::ZERO, |m, p| m.max(p.xyz().abs()));
        let slack = rounding(magnitude);
        let mut planes = Vec::new();
        for (i, a) in points.iter().enumerate() {
            for (j, b) in points.iter().enumerate().skip(i + 1) {
                for c in &points[j + 1..] {
                    let plane = null_vector(*a, *b, *c);
                    planes.extend(
                        [plane, -plane]
                            .into_iter()
                            .filter_map(|p| support(p, points)),
                    );
                }
            }
        }
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let both = [axis.extend(0.0), (-axis).extend(0.0)];
            planes.extend(both.into_iter().filter_map(|p| bound(p, points)));
        }
        for plane in &mut planes {
            plane.w -= plane.xyz().abs().dot(slack);
        }
        Self { planes }
    }

    /// Whether a plane separates the box from the hull: then they share no point. Where none does,
    /// they may still miss each other.
    pub fn misses(&self, world: &WorldBox) -> bool {
        self.planes
            .iter()
            .any(|plane| world.nearest(plane.xyz()) + plane.w > 0.0)
    }

    /// The same for a sphere.
    pub fn misses_sphere(&self, centre: DVec3, radius: f64) -> bool {
        self.planes
            .iter()
            .any(|plane| plane.xyz().dot(centre) + plane.w > radius)
    }
}

/// The plane, its normal of length 1, if no point is beyond it by more than rounding.
fn support(plane: DVec4, points: &[DVec4]) -> Option<DVec4> {
    let length = plane.xyz().length();
    if length == 0.0 || !length.is_finite() {
        return None;
    }
    let plane = plane / length;
    let inside = |p: &DVec4| plane.dot(*p) <= ROUNDING * plane.abs().dot(p.abs());
    points.iter().all(inside).then_some(())?;
    bound(plane.xyz().extend(0.0), points)
}

/// The plane of this normal that touches the points, if directions do not run through any such.
fn bound(normal: DVec4, points: &[DVec4]) -> Option<DVec4> {
    let mut farthest = f64::NEG_INFINITY;
    for point in points {
        let along = normal.dot(*point);
        if point.w != 0.0 {
            farthest = farthest.max(along);
        } else if along > ROUNDING * normal.abs().dot(point.abs()) {
            return None;
        }
    }
    Some(normal.xyz().extend(-farthest)).filter(|plane| plane.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64, z: f64) -> DVec4 {
        DVec4::new(x, y, z, 1.0)
    }

    /// A square of side 2 around the origin in the plane z = 0, and one more point.
    fn pyramid(apex: DVec4) -> Hull {
        let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let mut points: Vec<_> = square.iter().map(|&(x, y)| point(x, y, 0.0)).collect();
        points.push(apex);
        Hull::new(&points)
    }

    fn cube(x: f64, y: f64, z: f64, half: f64) -> WorldBox {
        WorldBox::new(DVec3::new(x, y, z), DVec3::splat(half))
    }

    #[test]
    fn a_pyramid_is_missed_beside_and_hit_inside() {
        let hull = pyramid(point(0.0, 0.0, 4.0));
        assert!(!hull.misses(&cube(0.0, 0.0, 2.0, 0.1)));
        assert!(!hull.misses(&cube(0.9, 0.0, 2.0, 0.5)));
        // Beside the slope at half height, where the box around the pyramid still is.
        assert!(hull.misses(&cube(0.9, 0.0, 2.0, 0.1)));
        assert!(hull.misses(&cube(0.0, 0.0, 4.2, 0.1)));
        assert!(hull.misses(&cube(0.0, 0.0, -0.2, 0.1)));
    }

    #[test]
    fn a_direction_makes_a_prism_without_end() {
        let hull = pyramid(DVec4::new(0.5, 0.0, 1.0, 0.0));
        assert!(!hull.misses(&cube(500.0, 0.0, 1000.0, 0.1)));
        assert!(hull.misses(&cube(500.0, 1.2, 1000.0, 0.1)));
        assert!(hull.misses(&cube(502.0, 0.0, 1000.0, 0.1)));
        assert!(hull.misses(&cube(0.0, 0.0, -0.2, 0.1)));
    }

    #[test]
    fn opposite_directions_are_the_whole_space() {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let directions = axes.into_iter().flat_map(|a| [a, -a]);
        let points: Vec<_> = directions
            .map(|d| d.extend(0.0))
            .chain([point(0.0, 0.0, 0.0)])
            .collect();
        assert!(!Hull::new(&points).misses(&cube(1e3, -1e3, 1e3, 0.1)));
    }

    #[test]
    fn a_light_in_the_plane_of_the_rectangle_leaves_a_flat_hull() {
        let hull = pyramid(point(5.0, 0.0, 0.0));
        assert!(!hull.misses(&cube(3.0, 0.0, 0.05, 0.1)));
        assert!(hull.misses(&cube(3.0, 0.0, 0.2, 0.1)));
        assert!(hull.misses(&cube(3.0, 1.2, 0.0, 0.1)));
    }

    #[test]
    fn no_point_of_the_hull_is_ever_outside() {
        // Whatever the planes are, convex combinations of the points are on the inner side.
        let mut state = 7_u64;
        let mut random = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
        };
        for _ in 0..200 {
            let points: Vec<_> = (0..9)
                .map(|i| DVec3::new(random(), random(), random()).extend(f64::from(i % 3 != 0)))
                .collect();
            let hull = Hull::new(&points);
            let mix: DVec4 = points.iter().map(|p| *p * random().abs()).sum();
            let inside = mix.xyz() / mix.w;
            assert!(!hull.misses(&cube(inside.x, inside.y, inside.z, 1e-9)));
        }
    }
}
