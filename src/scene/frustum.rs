//! What a host's view shows of the world.

use glam::{DMat4, DVec3, DVec4, Vec4Swizzles};

use crate::{DepthConvention, View};

/// Half-spaces and corners of a view's frustum, the corners homogeneous: those of an infinite far
/// plane are directions.
pub(crate) struct Frustum {
    planes: Vec<DVec4>,
    corners: Vec<DVec4>,
    eye: Option<DVec3>,
}

impl Frustum {
    pub fn new(view: &View) -> Self {
        let matrix = view.clip_from_world().as_dmat4();
        let (x, y, z, w) = (matrix.row(0), matrix.row(1), matrix.row(2), matrix.row(3));
        let mut planes = vec![w - x, w + x, w - y, w + y];
        // The near plane; what lies beyond the far one is no receiver either.
        match view.depth() {
            DepthConvention::InfiniteReverse => planes.push(w - z),
            DepthConvention::FiniteReverse | DepthConvention::Standard => {
                planes.extend([w - z, z]);
            }
        }
        let eye = view.eye();
        Self {
            planes,
            corners: corners(matrix),
            eye: (eye.w != 0.0).then(|| eye.xyz() / eye.w),
        }
    }

    /// How much the shadows of a light with a range can matter on screen: 1 where the eye is within its range, then
    /// falling with the square of the distance, as the size of its range on screen does.
    pub fn weight(&self, light: DVec3, range: f64) -> f64 {
        let distance = self.eye.map_or(range, |eye| eye.distance(light));
        (range / distance.max(range)).powi(2)
    }

    /// Whether the view surely shows nothing of a region.
    pub fn misses(&self, region: &Region) -> bool {
        let apart = |planes: &[DVec4], points: &[DVec4], margin: f64| {
            planes.iter().any(|plane| {
                let behind = -margin * plane.xyz().length();
                points.iter().all(|point| plane.dot(*point) < behind)
            })
        };
        apart(&self.planes, &region.points, region.margin)
            || apart(&region.sides, &self.corners, 0.0)
    }
}

/// Where receivers may be: around the hull of some points, and before some planes.
pub(crate) struct Region {
    pub points: Vec<DVec4>,
    pub margin: f64,
    pub sides: Vec<DVec4>,
}

fn corners(clip_from_world: DMat4) -> Vec<DVec4> {
    let world_from_clip = clip_from_world.inverse();
    (0..8)
        .map(|i| {
            let sign = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
            let depth = f64::from(i & 4) / 4.0;
            // In front of the eye clip w is above 0, and so is the w of the point.
            world_from_clip * DVec4::new(sign(1), sign(2), depth, 1.0)
        })
        .collect()
}
