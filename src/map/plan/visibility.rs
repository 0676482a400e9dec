//! Whether a host's view can show any receiver that looks a face up.

use glam::{DVec3, DVec4};

use crate::map::projection::{ALL_FACES, CubeFace, FlatFrame, LightProjection};
use crate::scene::{Frustum, Region};
use crate::{PointLight, Radius};

/// How much longer than their radius kernels are along the surface at most
/// ([`ContactHardening`](crate::ContactHardening)).
const STRETCH: f64 = 4.0;

/// A mask of the tiles that kernels may read for something that any view shows, never too few. Without
/// a view all are read. A directional light's tiles lie where they are seen.
pub(crate) fn visible_tiles(
    views: &[Frustum],
    light: &LightProjection,
    reach: Radius,
    size: u32,
) -> u8 {
    let of_view = |frustum| match light {
        LightProjection::Point(light) => visible_faces(frustum, light, reach, size),
        LightProjection::Spot(frame) => u8::from(!frustum.misses(&around_cone(frame, reach, size))),
        LightProjection::Cascades(_) => light.all(),
    };
    match views {
        [] => light.all(),
        _ => views.iter().map(of_view).fold(0, |all, mask| all | mask),
    }
}

/// A mask of the faces that kernels may read for something that the view shows, never too few.
fn visible_faces(frustum: &Frustum, light: &PointLight, reach: Radius, size: u32) -> u8 {
    let (texels, world) = reach.reach();
    let margin = STRETCH * f64::from(world);
    let Some(wide) = widened(f64::from(texels), f64::from(size)) else {
        return match frustum.misses(&around_range(light)) {
            true => 0,
            false => ALL_FACES,
        };
    };
    CubeFace::ALL
        .into_iter()
        .filter(|face| !frustum.misses(&around_face(light, *face, wide, margin)))
        .fold(0, |mask, face| mask | face.bit())
}

/// What a spot lights, and all from where kernels reach into its map.
fn around_cone(frame: &FlatFrame, reach: Radius, size: u32) -> Region {
    let axes = [frame.right, frame.up, frame.forward].map(|axis| axis.as_dvec3());
    let (wide, range) = (1.0 / f64::from(frame.scale), f64::from(frame.range));
    let (texels, world) = reach.reach();
    // No texel is wider for a receiver than for one at the end of the range.
    let widest = 2.0 * wide * range / f64::from(size);
    let margin = STRETCH * (f64::from(world) + f64::from(texels) * widest);
    around_pyramid(frame.origin.as_dvec3(), axes, wide, range, margin)
}

/// Whatever a light may reach.
fn around_range(light: &PointLight) -> Region {
    let (centre, range) = (light.position.as_dvec3(), f64::from(light.range));
    let sign = |i: i32, bit: i32| if i & bit == 0 { -range } else { range };
    let corner = |i| centre + DVec3::new(sign(i, 1), sign(i, 2), sign(i, 4));
    Region {
        points: (0..8).map(|i| corner(i).extend(1.0)).collect(),
        margin: 0.0,
        sides: CubeFace::ALL
            .map(|face| below(centre, face.axes()[2].as_dvec3(), range))
            .into(),
    }
}

/// In range, and in a face's pyramid, made `wide` times as wide, or within `margin` of it.
fn around_face(light: &PointLight, face: CubeFace, wide: f64, margin: f64) -> Region {
    let (apex, range) = (light.position.as_dvec3(), f64::from(light.range));
    let axes = face.axes().map(|axis| axis.as_dvec3());
    around_pyramid(apex, axes, wide, range, margin)
}

/// In a pyramid that is `wide` half as wide as it is high, up to a range, or within `margin` of it.
fn around_pyramid(apex: DVec3, axes: [DVec3; 3], wide: f64, range: f64, margin: f64) -> Region {
    let [right, up, forward] = axes;
    // What is in range is so along the axis, too; what it is near to may lie beyond.
    let far = range + margin;
    let mut points = vec![apex.extend(1.0)];
    for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let corner = apex + far * (forward + wide * (s * right + t * up));
        points.push(corner.extend(1.0));
    }
    let mut sides = vec![below(apex, forward, range)];
    for side in [right, -right, up, -up] {
        let inward = (wide * forward + side).normalize();
        sides.push(inward.extend(margin - inward.dot(apex)));
    }
    Region {
        points,
        margin,
        sides,
    }
}

/// The half-space up to a distance from a point along an axis.
fn below(point: DVec3, axis: DVec3, distance: f64) -> DVec4 {
    (-axis).extend(axis.dot(point) + distance)
}

/// How many times as wide as a face's pyramid that is in which receivers lie whose kernels of some
/// texels' radius may read the face; `None` if they may be anywhere.
fn widened(texels: f64, size: f64) -> Option<f64> {
    // The kernel's radius in distances of the receiver along its major axis.
    let radius = 2.0 * texels / size;
    // A disk stretched along the ray is as wide as ever across it, but may lie so much nearer to
    // the light, where it subtends more.
    let across = radius / (1.0 - STRETCH * radius);
    // A point that far from a pyramid's side, whose normal is (1, 1), is so far from it along an axis.
    let along = std::f64::consts::SQRT_2 * across;
    (STRETCH * radius < 1.0 && along < 1.0).then(|| 1.0 / (1.0 - along))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use glam::camera::rh::{proj::directx as proj, view};

    use super::*;
    use crate::{DepthConvention, View};

    fn random(state: &mut u32) -> f64 {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(*state >> 8) / f64::from(1 << 23) - 1.0
    }

    /// A point that a kernel may read for a receiver at `point`, both relative to the light.
    fn tap(state: &mut u32, point: DVec3, reach: Radius, size: u32) -> DVec3 {
        let (texels, world) = reach.reach();
        let texel = 2.0 * point.abs().max_element() / f64::from(size);
        let radius = f64::from(world) + f64::from(texels) * texel;
        let (a, b) = point.normalize().any_orthonormal_pair();
        let (sine, cosine) = (random(state) * std::f64::consts::PI).sin_cos();
        let across = radius * random(state) * (cosine * a + sine * b);
        let along = radius * random(state) * (STRETCH * STRETCH - 1.0).sqrt();
        point + across + along * point.normalize()
    }

    fn face_of(direction: DVec3) -> CubeFace {
        let along = |face: &CubeFace| face.axes()[2].as_dvec3().dot(direction);
        let mut faces = CubeFace::ALL.into_iter();
        let major = direction.abs().max_element();
        faces.find(|face| along(face) == major).unwrap()
    }

    #[test]
    fn no_face_that_a_kernel_reads_for_a_visible_point_in_range_is_missed() {
        for (reach, size) in [
            (Radius::Texels(12.0), 256),
            (Radius::Texels(64.0), 1024),
            (Radius::Texels(12.0), 64),
            (Radius::World(0.4), 1024),
        ] {
            let (missed, hidden) = missed_and_hidden(reach, reach, size);
            assert_eq!(missed, 0, "{reach:?}, {size}");
            assert!(hidden > 20, "next to nothing: {hidden}, {reach:?}, {size}");
            // The broken twin: faces for narrower kernels.
            let (missed, _) = missed_and_hidden(Radius::Texels(0.01), reach, size);
            assert!(missed > 10, "{missed}, {reach:?}, {size}");
        }
    }

    /// Taps of kernels that reach `taps` on faces that are not among those for `reach`, and how many
    /// those are not.
    fn missed_and_hidden(reach: Radius, taps: Radius, size: u32) -> (u32, u32) {
        let mut state = 9;
        let (mut missed, mut hidden) = (0, 0);
        for i in 0..400 {
            let mut vector = |scale: f64| {
                (DVec3::new(random(&mut state), random(&mut state), random(&mut state)) * scale)
                    .as_vec3()
            };
            let light = PointLight::new(vector(10.0), 6.0);
            let (eye, target, up) = match i % 2 {
                0 => (vector(15.0), vector(5.0), Vec3::new(0.1, 1.0, 0.0)),
                // Nearly all of one face, and nothing of the others.
                _ => {
                    let [_, up, forward] = CubeFace::ALL[i / 2 % 6].axes();
                    (light.position, light.position + forward, up)
                }
            };
            let camera = view::look_at_mat4(eye, target, up);
            let (projection, depth) = match i % 5 {
                0 => (
                    proj::perspective_infinite_reverse(1.5, 1.05, 0.1),
                    DepthConvention::InfiniteReverse,
                ),
                1 => (
                    proj::perspective(1.5, 1.05, 0.1, 30.0),
                    DepthConvention::Standard,
                ),
                2 => (
                    proj::perspective(1.5, 1.05, 30.0, 0.1),
                    DepthConvention::FiniteReverse,
                ),
                // Off centre, and from behind the camera.
                3 => (
                    proj::orthographic(-3.0, 2.0, -1.0, 4.0, -20.0, 9.0),
                    DepthConvention::Standard,
                ),
                _ => (
                    proj::orthographic(-3.0, 2.0, -1.0, 4.0, 30.0, -2.0),
                    DepthConvention::FiniteReverse,
                ),
            };
            let matrix = projection * camera;
            let frustum = Frustum::new(&View::new(matrix, depth).unwrap());
            let mask = visible_faces(&frustum, &light, reach, size);
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
                let at = [offset, tap(&mut state, offset, taps, size)].map(face_of);
                missed += u32::from(shown && at.iter().any(|face| mask & face.bit() == 0));
            }
        }
        (missed, hidden)
    }
}
