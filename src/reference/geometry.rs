//! World-space triangles in f64, and the two ray queries: the nearest hit, and whether anything blocks.

use std::fmt;
use std::sync::Arc;

use glam::{DVec3, DVec4, Vec4Swizzles};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

use super::ray::{Meeting, Ray};

/// How far a point computed here may lie from where it ought to, relative to its coordinates.
///
/// A hit point is `origin + t * direction`: t has some ten roundings, the corners of the triangle
/// one transform (seven), the camera ray one matrix inverse. 64 machine epsilons cover them.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [DVec3; 3],
    /// Object and triangle within it, as the caller numbers them.
    pub(super) source: [u32; 2],
}

impl Triangle {
    pub(super) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    /// On which side of the triangle's plane a homogeneous point lies: +1 where the corners appear
    /// counter-clockwise, -1 behind, 0 where rounding could turn the sign.
    ///
    /// `size` is the largest coordinate that the point was computed from. The bound has two parts:
    /// the point's and the corners' own uncertainty, and that of the determinant (Shewchuk,
    /// "Adaptive Precision Floating-Point Arithmetic", 1997, bound A, rounded up).
    pub(super) fn side(&self, point: DVec4, size: f64) -> f64 {
        let [a, b, c] = self.corners;
        let (ab, ac, to) = (b - a, c - a, point.xyz() - point.w * a);
        let normal = ab.cross(ac);
        let (x, y) = (ab.abs(), ac.abs());
        let permanent = DVec3::new(
            x.y * y.z + x.z * y.y,
            x.z * y.x + x.x * y.z,
            x.x * y.y + x.y * y.x,
        )
        .dot(to.abs());
        let size = point.w * self.size().max(size);
        let bound = normal.length() * ROUNDING * size + 8.0 * f64::EPSILON * permanent;
        let determinant = normal.dot(to);
        if determinant.abs() > bound {
            determinant.signum()
        } else {
            0.0
        }
    }

    /// On which side a light is.
    pub(super) fn light_side(&self, light: DVec4) -> f64 {
        self.side(light, light.xyz().abs().max_element())
    }

    /// The largest coordinate.
    pub(super) fn size(&self) -> f64 {
        self.corners
            .iter()
            .map(|corner| corner.abs().max_element())
            .fold(0.0, f64::max)
    }
}

/// A point of a surface: where it is, on which triangle, and how precisely that is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfacePoint {
    pub(super) position: DVec3,
    pub(super) triangle: u32,
    /// The largest coordinate that the position was computed from.
    pub(super) size: f64,
}

/// The point where a ray crosses a triangle, for
/// [`ReferenceScene::with_opacity`](super::ReferenceScene::with_opacity).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Crossing {
    /// Index of the object in the list passed to [`ReferenceScene::new`](super::ReferenceScene::new).
    pub object: u32,
    /// Triangle of that object, in the order of its indices.
    pub triangle: u32,
    /// Barycentric weights of the triangle's corners, in the order of its indices; they add up to 1.
    pub weights: [f64; 3],
}

/// Whether a triangle is there at a place.
pub(super) type Opacity = dyn Fn(&Crossing) -> bool + Send + Sync;

/// The triangles, with what is cut out of them. A clone shares the triangles.
#[derive(Clone)]
pub(super) struct Geometry {
    shared: Arc<Shared>,
    opacity: Option<Arc<Opacity>>,
}

struct Shared {
    triangles: Vec<Triangle>,
    seen: Bvh,
    casting: Bvh,
}

impl fmt::Debug for Geometry {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let triangles = self.shared.triangles.len();
        formatter
            .debug_struct("Geometry")
            .field("triangles", &triangles)
            .field("has_opacity", &self.opacity.is_some())
            .finish_non_exhaustive()
    }
}

impl Geometry {
    /// A hierarchy of all triangles, and one of those that block light.
    pub(super) fn new(mut casting: Vec<Triangle>, others: Vec<Triangle>) -> Self {
        let casters = casting.len();
        casting.extend(others);
        let triangles = casting;
        // The triangle test rounds relative to the coordinates, so the boxes grow by as much.
        let size = triangles.iter().map(Triangle::size).fold(0.0, f64::max);
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|triangle| bounds(triangle, ROUNDING * size))
            .collect();
        // parry numbers leaves by their place, so the casters come first in both.
        let hierarchy = |boxes| Bvh::from_leaves(BvhBuildStrategy::Binned, boxes);
        Self {
            shared: Arc::new(Shared {
                seen: hierarchy(&boxes),
                casting: hierarchy(&boxes[..casters]),
                triangles,
            }),
            opacity: None,
        }
    }

    /// The same triangles, there only where this says so.
    pub(super) fn with_opacity(&self, opacity: Arc<Opacity>) -> Self {
        Self {
            shared: Arc::clone(&self.shared),
            opacity: Some(opacity),
        }
    }

    pub(super) fn triangle(&self, index: u32) -> &Triangle {
        &self.shared.triangles[index as usize]
    }

    /// Where a ray meets a triangle, and the triangle is there.
    fn meets(&self, ray: &Ray, index: u32) -> Option<Meeting> {
        let triangle = self.triangle(index);
        let meeting = ray.meets(&triangle.corners)?;
        let [object, place] = triangle.source;
        let crossing = Crossing {
            object,
            triangle: place,
            weights: meeting.weights,
        };
        let opacity = self.opacity.as_ref();
        opacity
            .is_none_or(|opacity| opacity(&crossing))
            .then_some(meeting)
    }

    /// The nearest triangle along a ray, up to parameter `end`, and the ray's parameter there.
    pub(super) fn nearest(&self, origin: DVec3, direction: DVec3, end: f64) -> Option<(u32, f64)> {
        let ray = Ray::new(origin, direction, end);
        self.shared.seen.find_best(
            f64::MAX,
            |node, best| enters(&ray, node, best).min(f64::MAX),
            |index, _| {
                self.meets(&ray, index)
                    .map(|meeting| meeting.t)
                    .filter(|t| (0.0..=end).contains(t))
            },
        )
    }

    /// The casting triangles whose boxes come as near as `radius` to the line from a point to a homogeneous
    /// light, and some others.
    pub(super) fn casting_near(
        &self,
        position: DVec3,
        light: DVec4,
        radius: f64,
    ) -> impl Iterator<Item = &Triangle> {
        let to_light = light.xyz() - light.w * position;
        let end = if light.w == 0.0 { f64::INFINITY } else { 1.0 };
        let touches = move |node: &BvhNode| {
            let [low, high] = [node.mins(), node.maxs()].map(|end| DVec3::from(end.to_array()));
            let from = 0.5 * (low + high) - position;
            let along = (from.dot(to_light) / to_light.length_squared()).clamp(0.0, end);
            (from - along * to_light).length() <= radius + 0.5 * (high - low).length()
        };
        let leaves = self.shared.casting.leaves(touches);
        leaves.map(|index| self.triangle(index))
    }

    /// Whether a casting triangle lies between a surface and a homogeneous light.
    ///
    /// A triangle blocks if the line from surface to light passes through it and if the two lie
    /// strictly on opposite sides of its plane. That is the whole treatment of self-shadowing: the
    /// surface's own triangle, a coplanar duplicate and the neighbour across a shared edge all have
    /// the point in their plane, so that a ray can meet them only at its start; how close to the
    /// start the rounded hit falls, which depends on the angle, does not enter. For the same reason
    /// a triangle whose plane holds the light, thus edge-on to it, casts no shadow.
    pub(super) fn blocked(&self, surface: &SurfacePoint, light: DVec4) -> bool {
        let position = surface.position;
        let ray = ray_to(position, light);
        let size = surface.size.max(light.xyz().abs().max_element() * light.w);
        let point = position.extend(1.0);
        let separates = |index: u32| {
            let triangle = self.triangle(index);
            index != surface.triangle
                && self.meets(&ray, index).is_some()
                && triangle.side(point, size) * triangle.side(light, size) < 0.0
        };
        self.shared
            .casting
            .leaves(|node| enters(&ray, node, f64::MAX) < f64::INFINITY)
            .any(separates)
    }
}

fn ray_to(position: DVec3, light: DVec4) -> Ray {
    let end = if light.w == 0.0 { f64::INFINITY } else { 1.0 };
    Ray::new(position, light.xyz() - light.w * position, end)
}

fn enters(ray: &Ray, node: &BvhNode, end: f64) -> f64 {
    ray.enters(node.mins().to_array(), node.maxs().to_array(), end)
}

fn bounds(triangle: &Triangle, margin: f64) -> Aabb {
    let [a, b, c] = triangle.corners;
    let low = a.min(b).min(c) - margin;
    let high = a.max(b).max(c) + margin;
    Aabb::new(
        Vector::from_array(low.to_array()),
        Vector::from_array(high.to_array()),
    )
}
