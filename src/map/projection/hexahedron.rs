//! Convex bodies with eight corners, and where two overlap.

use glam::DVec3;

use super::light_box::{LightAxes, LightBox};
use crate::mesh::Bounds;

/// A box, or what a view shows between two depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hexahedron {
    /// Those of one face in turn, then their neighbours on the opposite face.
    corners: [DVec3; 8],
    /// Of each face: a point on it, and a direction inward of any length.
    faces: [(DVec3, DVec3); 6],
}

const EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

impl Hexahedron {
    /// Between two parallel rectangles, of which the first may be very small.
    pub fn between(corners: [DVec3; 8]) -> Self {
        let middle = corners.iter().sum::<DVec3>() / 8.0;
        let facing = |point: DVec3, normal: DVec3| match normal.dot(middle - point) < 0.0 {
            true => (point, -normal),
            false => (point, normal),
        };
        let across = (corners[5] - corners[4]).cross(corners[7] - corners[4]);
        let ends = [corners[0], corners[4]].map(|point| facing(point, across));
        let side = |i: usize| {
            let (along, next) = (corners[i + 4] - corners[i], corners[(i + 1) % 4 + 4]);
            facing(corners[i + 4], along.cross(next - corners[i + 4]))
        };
        let faces = [ends[0], ends[1], side(0), side(1), side(2), side(3)];
        Self { corners, faces }
    }

    /// A box in world space, which may be flat.
    pub fn of_bounds(bounds: &Bounds) -> Self {
        let [min, max] = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
        let corner = |i: usize| {
            // Around a face: 0, 1, 3, 2 as bits of x and y.
            let (x, y, z) = ((i ^ (i >> 1)) & 1, (i >> 1) & 1, i >> 2);
            let of = |bit: usize, axis: usize| if bit == 0 { min[axis] } else { max[axis] };
            DVec3::new(of(x, 0), of(y, 1), of(z, 2))
        };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let face = |i: usize| match i < 3 {
            true => (min, axes[i]),
            false => (max, -axes[i - 3]),
        };
        Self {
            corners: std::array::from_fn(corner),
            faces: std::array::from_fn(face),
        }
    }

    /// The box around it in a light's axes.
    pub fn around(&self, axes: &LightAxes) -> LightBox {
        let corners = self.corners.map(|corner| axes.local(corner));
        let (min, max) = corners
            .into_iter()
            .fold((corners[0], corners[0]), |(min, max), corner| {
                (min.min(corner), max.max(corner))
            });
        LightBox { min, max }
    }

    /// The box around what both share in a light's axes; `None` if they do not touch.
    ///
    /// The corners of what two convex bodies share lie where an edge of one enters or leaves the other, or
    /// ends within it.
    pub fn overlap(&self, other: &Self, axes: &LightAxes) -> Option<LightBox> {
        let ends = |of: &Self, within: &Self| {
            let inside =
                EDGES.map(|edge| within.part_inside(edge.map(|corner| of.corners[corner])));
            inside.into_iter().flatten().flatten()
        };
        let points = ends(self, other).chain(ends(other, self));
        LightBox::around(points.map(|point| axes.local(point)))
    }

    /// The ends of what of an edge is inside.
    fn part_inside(&self, [from, to]: [DVec3; 2]) -> Option<[DVec3; 2]> {
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for (point, inward) in self.faces {
            let [begin, end] = [from, to].map(|of| inward.dot(of - point));
            match (begin < 0.0, end < 0.0) {
                (true, true) => return None,
                (true, false) => first = first.max(begin / (begin - end)),
                (false, true) => last = last.min(begin / (begin - end)),
                (false, false) => {}
            }
        }
        (first <= last).then(|| [first, last].map(|share| from.lerp(to, share)))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::DirectionalLight;

    fn axes(toward_light: [f32; 3]) -> LightAxes {
        LightAxes::of(&DirectionalLight {
            toward_light: toward_light.into(),
        })
    }

    fn bounds(middle: [f32; 3], half: [f32; 3]) -> Bounds {
        let (middle, half) = (Vec3::from(middle), Vec3::from(half));
        Bounds {
            min: middle - half,
            max: middle + half,
        }
    }

    /// A pyramid without its top, from the origin along z.
    fn pyramid(from: f64, to: f64, half: f64) -> Hexahedron {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        Hexahedron::between(std::array::from_fn(|i| {
            let (x, y) = corners[i % 4];
            DVec3::new(x * half, y * half, 1.0) * if i < 4 { from } else { to }
        }))
    }

    #[test]
    fn a_body_within_another_is_what_they_share() {
        let light = axes([0.3, 1.0, -0.2]);
        let inner = Hexahedron::of_bounds(&bounds([0.1, -0.2, 5.0], [0.5, 0.0, 0.7]));
        let outer = pyramid(0.1, 100.0, 0.5);
        let alone = inner.around(&light);
        for found in [inner.overlap(&outer, &light), outer.overlap(&inner, &light)] {
            let found = found.unwrap();
            let off = (found.min - alone.min)
                .abs()
                .max((found.max - alone.max).abs());
            assert!(off.max_element() < 1e-12, "{off}");
        }
        let aside = Hexahedron::of_bounds(&bounds([9.0, -0.2, 5.0], [0.5, 0.0, 0.7]));
        assert!(outer.overlap(&aside, &light).is_none());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn what_both_hold_is_in_the_box(
            toward in prop::array::uniform3(-1.0..1.0_f32),
            middle in prop::array::uniform3(-3.0..3.0_f32),
            half in prop::array::uniform3(prop_oneof![Just(0.0_f32), 0.1..4.0_f32]),
            slope in prop_oneof![Just(1e-4_f64), 0.1..10.0_f64],
            from in prop_oneof![Just(1e-6_f64), 0.1..2.0_f64],
            length in 0.5..4.0_f64,
        ) {
            prop_assume!(Vec3::from(toward).length() > 0.1);
            let light = axes(toward);
            let held = bounds(middle, half);
            let (view, body) = (pyramid(from, from + length, slope), Hexahedron::of_bounds(&held));
            let found = view.overlap(&body, &light);
            let steps = 24_u32;
            let share = |step: u32| f64::from(step) / f64::from(steps);
            let mut least = None::<LightBox>;
            for (u, v, w) in (0..=steps).flat_map(|u| {
                (0..=steps).flat_map(move |v| (0..=steps).map(move |w| (u, v, w)))
            }) {
                // Of the box, so that flat ones have some.
                let [min, max] = [held.min.as_dvec3(), held.max.as_dvec3()];
                let point = min + (max - min) * DVec3::new(share(u), share(v), share(w));
                let inside = point.z >= from && point.z <= from + length
                    && point.x.abs().max(point.y.abs()) <= slope * point.z;
                if inside {
                    let local = light.local(point);
                    let one = LightBox { min: local, max: local };
                    least = Some(least.map_or(one, |least| least.joined(&one)));
                }
            }
            if let Some(least) = least {
                let found = found.unwrap();
                prop_assert!((least.min - found.min).min_element() > -1e-9);
                prop_assert!((found.max - least.max).min_element() > -1e-9);
            }
        }
    }
}
