//! What a view shows between two distances, and which distances cascades divide it at.

use glam::DVec3;

use super::hexahedron::Hexahedron;
use super::light_box::{LightAxes, LightBox};
use crate::View;
use crate::map::cascades::{CascadeSplit, Cascades, DepthBounds};

/// How far a view counts a point to be.
#[cfg(test)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Distance {
    /// In perspective, from the eye: a camera that turns changes no distance.
    FromEye(DVec3),
    /// An orthographic view, from its near plane along a direction of length 1.
    Along { forward: DVec3, from: f64 },
}

#[cfg(test)]
impl Distance {
    pub fn of_view(view: &View) -> Self {
        match view.eye_point() {
            Some(eye) => Self::FromEye(eye),
            None => {
                let forward = view.forward().normalize();
                let from = forward.dot(view.near_corners()[0]);
                Self::Along { forward, from }
            }
        }
    }

    pub fn of(&self, point: DVec3) -> f64 {
        match *self {
            Self::FromEye(eye) => point.distance(eye),
            Self::Along { forward, from } => forward.dot(point) - from,
        }
    }
}

/// The distances that one cascade is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slice {
    /// Where the cascade before it begins to turn into it; of the first, where the view begins.
    pub from: f64,
    /// Where it begins to turn into the next one.
    pub blend_from: f64,
    /// Where the next one has taken over.
    pub to: f64,
}

/// The slices of a view, near ones first; none if nothing is seen as near as shadows are to be.
pub(crate) fn slices(view: &View, cascades: &Cascades, bounds: Option<DepthBounds>) -> Vec<Slice> {
    let (near, far) = ends(view, cascades, bounds);
    if near >= far {
        return Vec::new();
    }
    let rule = Rule::of(view, cascades.split, bounds.is_some());
    let split = rule.splits(near, far, cascades.count as usize);
    let mut from = near;
    split
        .windows(2)
        .map(|ends| {
            let to = ends[1];
            let blend_from = to - f64::from(cascades.blend) * (to - ends[0]);
            let slice = Slice {
                from,
                blend_from,
                to,
            };
            from = blend_from;
            slice
        })
        .collect()
}

/// How distances are divided.
enum Rule {
    Practical { lambda: f64 },
    Ground { nearest: f64 },
}

impl Rule {
    fn of(view: &View, split: CascadeSplit, are_depths_known: bool) -> Self {
        if view.eye_point().is_none() {
            // All of an orthographic view is seen at one scale.
            return Self::Practical { lambda: 0.0 };
        }
        match split {
            CascadeSplit::Auto if are_depths_known => Self::Ground { nearest: 0.0 },
            CascadeSplit::Auto => Self::Practical {
                lambda: f64::from(0.85_f32),
            },
            CascadeSplit::Practical { lambda } => Self::Practical {
                lambda: lambda.into(),
            },
            CascadeSplit::Ground { nearest } => Self::Ground {
                nearest: nearest.into(),
            },
        }
    }

    /// Where so many cascades begin and end, from one distance to another.
    fn splits(&self, near: f64, far: f64, count: usize) -> Vec<f64> {
        let mut splits: Vec<f64> = match *self {
            Self::Practical { lambda } => {
                let split = |cascade: usize| {
                    let share = cascade as f64 / count as f64;
                    let even = near + (far - near) * share;
                    match lambda {
                        0.0 => even,
                        _ => lambda * near * (far / near).powf(share) + (1.0 - lambda) * even,
                    }
                };
                (0..=count).map(split).collect()
            }
            Self::Ground { nearest } => {
                let first = Some(nearest).filter(|nearest| (near..far).contains(nearest));
                let first = first.unwrap_or(near);
                let mut splits = growing(far / first, count);
                splits.iter_mut().for_each(|split| *split *= first);
                splits
            }
        };
        (splits[0], splits[count]) = (near, far);
        splits
    }
}

/// From 1 to a number in so many steps, each by a factor of half of 1 and the square of the last.
fn growing(whole: f64, count: usize) -> Vec<f64> {
    let from = |first: f64| {
        let mut factor = first;
        let mut reached = 1.0;
        let mut all = vec![reached];
        for _ in 0..count {
            reached *= factor;
            all.push(reached);
            factor = 0.5 * (factor * factor + 1.0);
        }
        all
    };
    // Later factors are greater.
    let (mut low, mut high) = (1.0, whole.powf(1.0 / count as f64));
    // As many halvings as f64 has digits.
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = 0.5 * (low + high);
        match from(middle)[count] > whole {
            true => high = middle,
            false => low = middle,
        }
    }
    from(low)
}

/// The least and the greatest distance of what is seen and gets shadows.
fn ends(view: &View, cascades: &Cascades, bounds: Option<DepthBounds>) -> (f64, f64) {
    let bounds = bounds.map(|bounds| (f64::from(bounds.nearest), f64::from(bounds.farthest)));
    let (nearest, farthest) = bounds.unwrap_or((0.0, f64::INFINITY));
    let (near, far) = (view.near_corners(), view.far_corners());
    let forward = view.forward().normalize();
    match view.eye_point() {
        Some(eye) => {
            let depths = near.map(|corner| forward.dot(corner - eye));
            // How much farther the eye is from a point than its depth says, at most.
            let lines = view.sight_lines();
            let stretch = lines.map(|line| line.length() / forward.dot(line));
            let stretch = stretch.into_iter().fold(1.0, f64::max);
            let end = far.map_or(f64::INFINITY, |far| {
                far.map(|corner| corner.distance(eye))
                    .into_iter()
                    .fold(0.0, f64::max)
            });
            let begin = depths.into_iter().fold(f64::INFINITY, f64::min);
            let last = f64::from(cascades.distance).min(farthest * stretch);
            (begin.max(nearest), end.min(last))
        }
        None => {
            let length = far.map_or(0.0, |far| forward.dot(far[0] - near[0]));
            (nearest, farthest.min(length))
        }
    }
}

/// The box around a slice as a light sees it.
pub(super) fn box_of(view: &View, slice: &Slice, axes: &LightAxes) -> LightBox {
    match view.eye_point() {
        Some(eye) => {
            let cone = Cone::new(view.sight_lines());
            let eye = axes.local(eye);
            let end = |side: f64| {
                DVec3::from_array(axes.exact.map(|axis| {
                    let along = cone.extent(axis * side);
                    side * along * if along > 0.0 { slice.to } else { slice.from }
                }))
            };
            let (min, max) = (eye + end(-1.0), eye + end(1.0));
            LightBox { min, max }
        }
        None => {
            let corners = slab(view, slice).map(|corner| axes.local(corner));
            let (mut min, mut max) = (corners[0], corners[0]);
            for corner in corners {
                (min, max) = (min.min(corner), max.max(corner));
            }
            LightBox { min, max }
        }
    }
}

/// What holds all that a slice shows: in perspective between two depths.
pub(super) fn hull(view: &View, slice: &Slice, bounds: Option<DepthBounds>) -> Hexahedron {
    Hexahedron::between(match view.eye_point() {
        Some(eye) => {
            let forward = view.forward().normalize();
            let lines = view.sight_lines().map(|line| line / forward.dot(line));
            let stretch = lines.map(DVec3::length).into_iter().fold(1.0, f64::max);
            let (mut nearest, mut farthest) = (slice.from / stretch, slice.to);
            if let Some(bounds) = bounds {
                nearest = nearest.max(bounds.nearest.into());
                farthest = farthest.min(bounds.farthest.into());
            }
            std::array::from_fn(|corner| {
                let depth = if corner < 4 { nearest } else { farthest };
                eye + lines[corner % 4] * depth
            })
        }
        None => slab(view, slice),
    })
}

/// The box around a sphere that holds a slice, and does so in perspective whichever way the camera
/// turns.
pub(super) fn box_of_sphere(view: &View, slice: &Slice, axes: &LightAxes) -> LightBox {
    let (centre, radius) = match view.eye_point() {
        Some(eye) => (eye, slice.to),
        None => {
            let corners = slab(view, slice);
            let centre = corners.iter().sum::<DVec3>() / 8.0;
            let distances = corners.map(|corner| corner.distance(centre));
            (centre, distances.into_iter().fold(0.0, f64::max))
        }
    };
    let centre = axes.local(centre);
    let (min, max) = (centre - radius, centre + radius);
    LightBox { min, max }
}

/// The corners of what an orthographic view shows between two distances.
fn slab(view: &View, slice: &Slice) -> [DVec3; 8] {
    let (near, forward) = (view.near_corners(), view.forward().normalize());
    std::array::from_fn(|corner| {
        let distance = if corner < 4 { slice.from } else { slice.to };
        near[corner % 4] + forward * distance
    })
}

/// The directions in which a view in perspective sees, of length 1.
struct Cone {
    corners: [DVec3; 4],
    /// Of the plane through each corner and the next one, of length 1, and facing all others.
    sides: [DVec3; 4],
}

impl Cone {
    fn new(sight_lines: [DVec3; 4]) -> Self {
        let corners = sight_lines.map(DVec3::normalize);
        let sides = std::array::from_fn(|i| {
            let side = corners[i].cross(corners[(i + 1) % 4]).normalize();
            if side.dot(corners[(i + 2) % 4]) < 0.0 {
                -side
            } else {
                side
            }
        });
        Self { corners, sides }
    }

    /// How far any of the directions goes along another one, at most.
    fn extent(&self, along: DVec3) -> f64 {
        if self.sides.iter().all(|side| side.dot(along) >= 0.0) {
            return along.length();
        }
        let mut most = f64::NEG_INFINITY;
        for (i, side) in self.sides.iter().enumerate() {
            let (from, to) = (self.corners[i], self.corners[(i + 1) % 4]);
            most = most.max(along.dot(from));
            // The direction of the arc between two corners that comes nearest, if it lies between them.
            let nearest = along - *side * side.dot(along);
            let turn = from.cross(to);
            if turn.dot(from.cross(nearest)) > 0.0 && turn.dot(nearest.cross(to)) > 0.0 {
                most = most.max(nearest.length());
            }
        }
        most
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use glam::camera::rh::{proj::directx as proj, view as camera};
    use proptest::prelude::*;

    use super::*;
    use crate::{DepthConvention, DirectionalLight};

    fn view(degrees: f32, near: f32, far: Option<f32>) -> View {
        let camera = camera::look_at_mat4(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y);
        let angle = degrees.to_radians();
        let (projection, depth) = match far {
            None => (
                proj::perspective_infinite_reverse(angle, 1.5, near),
                DepthConvention::InfiniteReverse,
            ),
            Some(far) => (
                proj::perspective(angle, 1.5, near, far),
                DepthConvention::Standard,
            ),
        };
        View::new(projection * camera, depth).unwrap()
    }

    fn orthographic(near: f32, far: f32) -> View {
        let camera = camera::look_at_mat4(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y);
        let projection = proj::orthographic(-3.0, 4.0, -2.0, 5.0, near, far);
        View::new(projection * camera, DepthConvention::Standard).unwrap()
    }

    fn cascades(count: u32, lambda: f32, blend: f32) -> Cascades {
        Cascades {
            count,
            split: CascadeSplit::Practical { lambda },
            blend,
            ..Default::default()
        }
    }

    fn ends_of(slices: &[Slice]) -> Vec<f64> {
        slices.iter().map(|slice| slice.to).collect()
    }

    fn same(found: &[f64], expected: &[f64]) -> bool {
        let close = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() < 1e-5;
        found.len() == expected.len() && found.iter().zip(expected).all(close)
    }

    #[test]
    fn splits_go_by_the_practical_scheme() {
        let view = view(50.0, 0.01, None);
        let of = |lambda| ends_of(&slices(&view, &cascades(4, lambda, 0.0), None));
        assert!(same(&of(1.0), &[0.1, 1.0, 10.0, 100.0]), "{:?}", of(1.0));
        let even = |share: f64| 0.01 + 99.99 * share;
        assert!(same(&of(0.0), &[0.25, 0.5, 0.75, 1.0].map(even)));
        // Half way between the two.
        let half = [(0.1, 0.25), (1.0, 0.5), (10.0, 0.75), (100.0, 1.0)];
        assert!(same(
            &of(0.5),
            &half.map(|(log, share)| 0.5 * (log + even(share)))
        ));
        assert!(!same(&of(0.5), &of(0.4)));
    }

    /// The texels that pixels see on flat ground far and wide, in the mean: a cascade's are as wide as it is
    /// far. The camera is 1.7 above it, and the lowest pixels look down by 25 degrees.
    fn mean_texel(near: f32, distance: f32, lambda: f32) -> f64 {
        let view = view(50.0, near, None);
        let cascades = Cascades {
            distance,
            ..cascades(4, lambda, 0.0)
        };
        let lowest = 1.7 / 25.0_f64.to_radians().tan();
        let slices = slices(&view, &cascades, None).into_iter();
        let (sum, pixels) = slices.fold((0.0, 0.0), |(sum, pixels), slice| {
            // Rows of pixels are even in height over distance.
            let rows = (1.0 / slice.from.max(lowest) - 1.0 / slice.to).max(0.0);
            (sum + rows * slice.to, pixels + rows)
        });
        sum / pixels
    }

    #[test]
    fn the_default_split_is_nearly_the_best_for_what_stands_on_flat_ground() {
        let lambda = 0.85;
        let auto = |split| {
            let cascades = Cascades {
                split,
                ..Default::default()
            };
            ends_of(&slices(&view(50.0, 0.1, None), &cascades, None))
        };
        assert_eq!(
            auto(CascadeSplit::default()),
            auto(CascadeSplit::Practical { lambda })
        );
        let mut halves = 0.0_f64;
        for (near, distance) in [0.01, 0.1, 1.0]
            .into_iter()
            .flat_map(|near| [100.0, 300.0, 1000.0].map(|distance| (near, distance)))
        {
            let best = (0..=100).map(|percent| mean_texel(near, distance, percent as f32 / 100.0));
            let best = best.fold(f64::INFINITY, f64::min);
            let worse = mean_texel(near, distance, lambda) / best;
            assert!(worse < 1.33, "near {near}, distance {distance}: {worse}");
            halves = halves.max(mean_texel(near, distance, 0.5) / best);
        }
        // The broken twin: half way, as is often taken.
        assert!(halves > 2.0, "{halves}");
    }

    /// How many pixels wide the texels are that pixels see, in the mean over ground of which nothing nearer is
    /// seen: in units of what is the same for all splits.
    fn mean_pixels(ends: &[f64], nearest: f64) -> f64 {
        let mut from = nearest;
        let of = ends.iter().map(|&to| {
            let mean = to * (from.powi(-2) - to.powi(-2));
            from = to;
            mean
        });
        of.sum()
    }

    #[test]
    fn over_ground_no_other_split_has_texels_of_fewer_pixels() {
        let view = view(50.0, 0.1, None);
        let bounds = DepthBounds {
            nearest: 3.0,
            farthest: 1e4,
        };
        let of = |count, bounds, nearest| {
            let cascades = Cascades {
                count,
                split: CascadeSplit::Ground { nearest },
                distance: 700.0,
                ..Default::default()
            };
            ends_of(&slices(&view, &cascades, bounds))
        };
        for count in 1..=8 {
            let ends = of(count, Some(bounds), 0.0);
            assert_eq!((ends.len(), ends.last()), (count as usize, Some(&700.0)));
            assert!(same(&of(count, None, 3.0), &ends), "{ends:?}");
            let least = mean_pixels(&ends, 3.0);
            for moved in 0..ends.len() - 1 {
                for by in [0.97, 1.03] {
                    let mut other = ends.clone();
                    other[moved] *= by;
                    assert!(mean_pixels(&other, 3.0) > least, "{count} {moved} {by}");
                }
            }
        }
        // The broken twin: another rule is far from it, whichever number it takes.
        let ground = of(4, Some(bounds), 0.0);
        for lambda in [0.85, 0.95, 1.0] {
            let practical = slices(
                &view,
                &Cascades {
                    distance: 700.0,
                    ..cascades(4, lambda, 0.0)
                },
                Some(bounds),
            );
            let worse = mean_pixels(&ends_of(&practical), 3.0) / mean_pixels(&ground, 3.0);
            assert!(worse > 1.25, "{lambda}: {worse}");
        }
        // Known depths are asked for it, and what is beyond all shadows says nothing.
        let auto = Cascades {
            distance: 700.0,
            ..Default::default()
        };
        assert!(same(&ends_of(&slices(&view, &auto, Some(bounds))), &ground));
        assert!(same(&of(4, None, 800.0), &of(4, None, 0.0)));
        assert!(!same(&of(4, None, 3.0), &of(4, None, 0.0)));
    }

    #[test]
    fn each_cascade_begins_where_the_one_before_it_begins_to_turn_into_it() {
        for (view, count) in [(view(50.0, 0.1, None), 4), (orthographic(-5.0, 50.0), 8)] {
            let slices = slices(&view, &cascades(count, 0.75, 0.2), None);
            assert_eq!(slices.len(), count as usize);
            let mut start = slices[0].from;
            for (slice, next) in slices.iter().zip(&slices[1..]) {
                assert_eq!(next.from, slice.blend_from);
                let band = (slice.to - slice.blend_from) / (slice.to - start);
                assert!((band - 0.2).abs() < 1e-6, "{band}");
                start = slice.to;
            }
        }
        let sharp = slices(&view(50.0, 0.1, None), &cascades(4, 0.75, 0.0), None);
        assert!(sharp.iter().all(|slice| slice.blend_from == slice.to));
    }

    #[test]
    fn slices_end_where_the_view_or_what_is_seen_does() {
        let of = |view: &View, bounds| ends_of(&slices(view, &cascades(1, 0.75, 0.0), bounds));
        let bounds = |nearest, farthest| Some(DepthBounds { nearest, farthest });
        let endless = view(50.0, 0.1, None);
        assert!(same(&of(&endless, None), &[100.0]));
        // The corners of a far plane are farther than its middle, and so is what is seen there.
        let half = 25.0_f64.to_radians().tan();
        let stretch = (1.0 + half * half * (1.0 + 1.5 * 1.5)).sqrt();
        assert!(same(
            &of(&view(50.0, 0.1, Some(20.0)), None),
            &[20.0 * stretch]
        ));
        assert!(same(&of(&endless, bounds(5.0, 20.0)), &[20.0 * stretch]));
        assert!(same(&of(&endless, bounds(5.0, 500.0)), &[100.0]));
        let first = |view: &View, bounds| slices(view, &cascades(3, 0.75, 0.1), bounds)[0].from;
        assert!(same(&[first(&endless, bounds(5.0, 20.0))], &[5.0]));
        assert!(same(&[first(&endless, bounds(0.0, 20.0))], &[0.1]));
        // Nothing is seen as near as shadows are to be.
        assert!(of(&endless, bounds(150.0, 200.0)).is_empty());
        assert!(of(&view(50.0, 120.0, None), None).is_empty());
        // Orthographic: from the near plane to the far plane, even behind the camera.
        let parallel = orthographic(-200.0, 50.0);
        assert!(same(&of(&parallel, None), &[250.0]));
        assert!(same(&of(&parallel, bounds(100.0, 120.0)), &[120.0]));
        assert_eq!(first(&parallel, bounds(100.0, 120.0)), 100.0);
    }

    #[test]
    fn a_turn_changes_no_distance_from_the_eye() {
        let point = DVec3::new(4.0, -2.0, 7.0);
        let measure = Distance::of_view(&view(50.0, 0.1, None));
        let expected = point.distance(DVec3::new(1.0, 2.0, 3.0));
        assert!((measure.of(point) - expected).abs() < 1e-5);
        let measure = Distance::of_view(&orthographic(-2.0, 30.0));
        let [a, .., d] = orthographic(-2.0, 30.0).near_corners();
        assert!(measure.of(a).abs().max(measure.of(d).abs()) < 1e-5);
        let [far, ..] = orthographic(-2.0, 30.0).far_corners().unwrap();
        assert!((measure.of(far) - 32.0).abs() < 1e-4);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn the_box_of_a_slice_is_just_around_it(
            degrees in prop_oneof![Just(0.01_f32), Just(170.0), 1.0..160.0_f32],
            toward in prop::array::uniform3(-1.0..1.0_f32),
            from in 0.2..5.0_f64,
            length in 0.01..20.0_f64,
        ) {
            let toward = Vec3::from(toward);
            prop_assume!(toward.length() > 0.1);
            let axes = LightAxes::of(&DirectionalLight { toward_light: toward });
            let view = view(degrees, 0.1, None);
            let slice = Slice { from, blend_from: from, to: from + length };
            let around = box_of(&view, &slice, &axes);
            let sphere = box_of_sphere(&view, &slice, &axes);
            let eye = view.eye_point().unwrap();
            let [a, b, _, d] = view.sight_lines().map(|line| line / view.forward().dot(line));
            let steps = 24_u32;
            // Evenly by angle.
            let half = f64::from(degrees).to_radians() * 0.5;
            let share = |step: u32| {
                let angle = half * (2.0 * f64::from(step) / f64::from(steps) - 1.0);
                0.5 + 0.5 * angle.tan() / half.tan()
            };
            let points = (0..=steps).flat_map(|u| (0..=steps).map(move |v| (share(u), share(v))))
                .map(|(u, v)| (a + (b - a) * u + (d - a) * v).normalize())
                .flat_map(|line| [from, slice.to].map(|distance| eye + line * distance));
            let found = LightBox::around(points.map(|point| axes.local(point))).unwrap();
            let tolerance = 1e-5 * slice.to;
            prop_assert!((found.min - around.min).min_element() > -tolerance);
            prop_assert!((around.max - found.max).min_element() > -tolerance);
            // Between the points that were tried it may reach a little farther.
            let size = (around.max - around.min).max_element();
            let spare = (found.min - around.min).max(around.max - found.max);
            prop_assert!(spare.max_element() < 0.03 * size + tolerance, "{spare} of {size}");
            prop_assert!((around.min - sphere.min).min_element() > -tolerance);
            prop_assert!((sphere.max - around.max).min_element() > -tolerance);
        }
    }
}
