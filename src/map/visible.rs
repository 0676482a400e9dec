//! Whether a host's view can show any receiver that looks a face up.

use glam::{DMat4, DVec3, DVec4, Vec4Swizzles};

use super::face::CubeFace;
use crate::{DepthConvention, PointLight, View};

/// Texels by which a face is taken larger than it is, for kernels that reach over its edges.
const KERNEL_REACH: f64 = 32.0;

/// Half-spaces and corners of a view's frustum, the corners homogeneous: those of an infinite far
/// plane are directions.
pub(super) struct Frustum {
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
            eye: (eye.w.abs() > 1e-9 * eye.xyz().length()).then(|| eye.xyz() / eye.w),
        }
    }

    /// How much a light's shadows can matter on screen: 1 where the eye is within its range, then
    /// falling with the square of the distance, as the size of its range on screen does.
    pub fn weight(&self, light: &PointLight) -> f64 {
        let range = f64::from(light.range);
        let distance = self
            .eye
            .map_or(range, |eye| eye.distance(light.position.as_dvec3()));
        (range / distance.max(range)).powi(2)
    }

    /// A mask of the faces in whose pyramids the view may show something, never too few.
    pub fn faces(&self, light: &PointLight, size: u32) -> u8 {
        let wide = 1.0 + 2.0 * KERNEL_REACH / f64::from(size);
        CubeFace::ALL
            .into_iter()
            .filter(|face| !self.misses(light, *face, wide))
            .fold(0, |mask, face| mask | face.bit())
    }

    fn misses(&self, light: &PointLight, face: CubeFace, wide: f64) -> bool {
        let apex = light.position.as_dvec3();
        let range = f64::from(light.range);
        let [right, up, forward] = face.axes().map(|axis| axis.as_dvec3());
        // The pyramid from the light to its range along the major axis holds every point of the
        // face that is in range.
        let mut points = vec![apex.extend(1.0)];
        let mut sides = vec![cap(apex, forward, range)];
        for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let corner = apex + range * (forward + wide * (s * right + t * up));
            points.push(corner.extend(1.0));
        }
        for side in [right, -right, up, -up] {
            let normal = wide * forward + side;
            sides.push(normal.extend(-normal.dot(apex)));
        }
        let apart = |planes: &[DVec4], points: &[DVec4]| {
            planes
                .iter()
                .any(|plane| points.iter().all(|point| plane.dot(*point) < 0.0))
        };
        apart(&self.planes, &points) || apart(&sides, &self.corners)
    }
}

fn cap(apex: DVec3, forward: DVec3, range: f64) -> DVec4 {
    (-forward).extend(forward.dot(apex) + range)
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

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use glam::camera::rh::{proj::directx as proj, view};

    use super::*;

    fn random(state: &mut u32) -> f64 {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(*state >> 8) / f64::from(1 << 23) - 1.0
    }

    #[test]
    fn no_face_with_a_visible_point_in_range_is_missed() {
        let mut state = 9;
        let mut hidden = 0;
        for i in 0..400 {
            let mut vector = |scale: f64| {
                (DVec3::new(random(&mut state), random(&mut state), random(&mut state)) * scale)
                    .as_vec3()
            };
            let light = PointLight::new(vector(10.0), 0.1, 6.0);
            let camera = view::look_at_mat4(vector(15.0), vector(5.0), Vec3::new(0.1, 1.0, 0.0));
            let (projection, depth) = match i % 3 {
                0 => (
                    proj::perspective_infinite_reverse(0.8, 1.5, 0.1),
                    DepthConvention::InfiniteReverse,
                ),
                1 => (
                    proj::perspective(0.8, 1.5, 0.1, 30.0),
                    DepthConvention::Standard,
                ),
                _ => (
                    proj::perspective(0.8, 1.5, 30.0, 0.1),
                    DepthConvention::FiniteReverse,
                ),
            };
            let matrix = projection * camera;
            let frustum = Frustum::new(&View::new(matrix, depth).unwrap());
            let mask = frustum.faces(&light, 1024);
            hidden += 6 - mask.count_ones();
            for _ in 0..200 {
                let offset =
                    DVec3::new(random(&mut state), random(&mut state), random(&mut state)) * 6.0;
                if offset.length() > 6.0 {
                    continue;
                }
                let point = light.position.as_dvec3() + offset;
                let clip = matrix.as_dmat4() * point.extend(1.0);
                let shown = clip.x.abs() <= clip.w
                    && clip.y.abs() <= clip.w
                    && clip.z >= 0.0
                    && clip.z <= clip.w;
                let major = offset.abs().max_element();
                for face in CubeFace::ALL {
                    let on = face.axes()[2].as_dvec3().dot(offset) == major;
                    assert!(
                        !(shown && on) || mask & face.bit() != 0,
                        "{face:?}, {point}"
                    );
                }
            }
        }
        assert!(hidden > 400, "hides next to nothing: {hidden}");
    }
}
