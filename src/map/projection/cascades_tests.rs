use glam::camera::rh::{proj::directx as proj, view as camera};
use glam::{DVec3, Mat4, Vec3};

use super::*;
use crate::map::cascades::CascadeSplit;
use crate::map::projection::directional::{Fit, fit_directional};
use crate::{DepthConvention, Radius};

const SIZE: u32 = 1024;

fn sun() -> DirectionalLight {
    DirectionalLight {
        toward_light: Vec3::new(0.3, 1.0, -0.2),
    }
}

fn shape(reach: Radius) -> MapShape {
    MapShape {
        size: SIZE,
        reach,
        unclipped_depth: true,
    }
}

fn looking(eye: Vec3, along: Vec3) -> Mat4 {
    camera::look_to_mat4(eye, along.normalize(), Vec3::Y)
}

fn perspective(degrees: f32, eye: Vec3, along: Vec3) -> View {
    let projection = proj::perspective_infinite_reverse(degrees.to_radians(), 1.6, 0.1);
    View::new(
        projection * looking(eye, along),
        DepthConvention::InfiniteReverse,
    )
    .unwrap()
}

fn off_centre(eye: Vec3, along: Vec3) -> View {
    let mut projection = proj::perspective_infinite_reverse(0.8, 1.6, 0.1);
    (projection.z_axis.x, projection.z_axis.y) = (0.7, -0.4);
    View::new(
        projection * looking(eye, along),
        DepthConvention::InfiniteReverse,
    )
    .unwrap()
}

fn ending(eye: Vec3, along: Vec3) -> View {
    let projection = proj::perspective(0.8, 1.6, 0.1, 60.0);
    View::new(projection * looking(eye, along), DepthConvention::Standard).unwrap()
}

fn orthographic(eye: Vec3, along: Vec3) -> View {
    let projection = proj::orthographic(-9.0, 14.0, -4.0, 7.0, -20.0, 70.0);
    View::new(projection * looking(eye, along), DepthConvention::Standard).unwrap()
}

fn views(eye: Vec3, along: Vec3) -> Vec<View> {
    let wide = [0.01, 1.0, 50.0, 120.0, 170.0].map(|degrees| perspective(degrees, eye, along));
    let others = [off_centre, ending, orthographic].map(|view| view(eye, along));
    wide.into_iter().chain(others).collect()
}

/// Casters all around.
const EVERYWHERE: LightBox = LightBox {
    min: DVec3::splat(-2000.0),
    max: DVec3::splat(2000.0),
};

fn of<'a>(view: &'a View, light: &'a DirectionalLight, cascades: &'a Cascades) -> CascadesOf<'a> {
    CascadesOf {
        light,
        view,
        cascades,
        depth_bounds: None,
        receivers: None,
        shape: shape(Radius::Texels(12.0)),
        casters: Some(EVERYWHERE),
        last: &[],
    }
}

const FITS: [CascadeFit; 2] = [CascadeFit::Stable, CascadeFit::Tight];

fn fitted(fit: CascadeFit) -> Cascades {
    Cascades {
        fit,
        ..Default::default()
    }
}

fn frames(cascades: &[Cascade]) -> Vec<FlatFrame> {
    cascades
        .iter()
        .map(|cascade| cascade.map.unwrap().0)
        .collect()
}

fn placed(cascades: &[Cascade]) -> Vec<Option<Placed>> {
    let map = |cascade: &Cascade| cascade.map.map(|(_, placed)| placed);
    cascades.iter().map(map).collect()
}

/// Points of a slice: on its corners, its faces and inside.
fn points(view: &View, slice: &Slice) -> Vec<DVec3> {
    let [a, b, _, d] = view.near_corners();
    let lines = view
        .sight_lines()
        .map(|line| line / view.forward().dot(line));
    let [e, f, _, h] = lines;
    let shares = [0.0, 0.2, 0.5, 0.9, 1.0];
    let mut points = Vec::new();
    for (u, v, w) in shares.iter().flat_map(|&u| {
        shares
            .iter()
            .flat_map(move |&v| shares.map(move |w| (u, v, w)))
    }) {
        let distance = slice.from + (slice.to - slice.from) * w;
        points.push(match view.eye_point() {
            Some(eye) => eye + distance * (e + (f - e) * u + (h - e) * v).normalize(),
            None => {
                let along = view.forward().normalize();
                a + (b - a) * u + (d - a) * v + along * distance
            }
        });
    }
    points
}

/// How far inside a map's sides a point is, in texels, as shaders see it.
fn spare(frame: &FlatFrame, point: DVec3) -> f64 {
    let from = point - frame.origin.as_dvec3();
    let [right, up] = [frame.right, frame.up].map(|axis| axis.as_dvec3().dot(from).abs());
    (1.0 - right.max(up) * f64::from(frame.scale)) * f64::from(SIZE) / 2.0
}

/// The texels to spare of the point of a view's slices that has the fewest, less what kernels reach.
fn least_spare(of: &CascadesOf<'_>, points_of: &Cascades) -> f64 {
    let cascades = fit_cascades(of).unwrap();
    let slices = slices(of.view, points_of, None);
    let (texels, world) = of.shape.reach.reach();
    let mut least = f64::INFINITY;
    for (cascade, slice) in cascades.iter().zip(&slices) {
        let (frame, _) = cascade.map.unwrap();
        let texel = 2.0 / f64::from(frame.scale) / f64::from(SIZE);
        for point in points(of.view, slice) {
            let spare = spare(&frame, point) - f64::from(texels) - f64::from(world) / texel;
            least = least.min(spare);
        }
    }
    least
}

#[test]
fn every_point_of_a_slice_lies_in_its_cascade_with_the_reach_to_spare() {
    let light = sun();
    for (fit, count) in FITS
        .into_iter()
        .flat_map(|fit| [1, 4, 8].map(|count| (fit, count)))
    {
        let cascades = Cascades {
            count,
            ..fitted(fit)
        };
        let mut narrower_fails = 0;
        for view in views(Vec3::new(13.0, -7.0, 5.0), Vec3::new(0.3, -0.4, 1.0)) {
            for reach in [Radius::Texels(12.0), Radius::World(0.3)] {
                let mut of = of(&view, &light, &cascades);
                of.shape = shape(reach);
                // Half a texel is the tap's own.
                let least = least_spare(&of, &cascades);
                assert!(least > 0.499, "{fit:?} {count} {view:?}: {least}");
                // The broken twin: points of slices that are longer than the cascades were made for.
                let longer = Cascades {
                    distance: 1.4 * cascades.distance,
                    ..cascades
                };
                narrower_fails += u32::from(least_spare(&of, &longer) < 0.0);
            }
        }
        assert!(narrower_fails >= 6, "{fit:?} {count}: {narrower_fails}");
    }
}

#[test]
fn cascades_cover_their_slices_just_before_they_get_a_step_wider() {
    let light = sun();
    // To the side of the maps, where a slice's sphere ends as well.
    let right = LightAxes::of(&light).rounded[0];
    let view = perspective(50.0, Vec3::new(13.0, -7.0, 5.0), right);
    for fit in FITS {
        for reach in [Radius::Texels(12.0), Radius::World(2.5)] {
            let least = (0..200).map(|step| {
                // Over a quarter of an octave, and so through all of a step.
                let cascades = Cascades {
                    count: 1,
                    distance: 70.0 * (f32::from(step as u8) / 800.0).exp2(),
                    margin: 0.0,
                    ..fitted(fit)
                };
                let mut of = of(&view, &light, &cascades);
                of.shape = shape(reach);
                least_spare(&of, &cascades)
            });
            let least = least.fold(f64::INFINITY, f64::min);
            // Of two texels: one and a half for where the map may stay, half for the tap's own.
            assert!((0.499..2.6).contains(&least), "{fit:?} {reach:?}: {least}");
        }
    }
}

/// How many frames change as a camera turns in place in 64 steps, looking up and down too.
fn changes_in_a_turn(fit: CascadeFit, eye: Vec3, view: fn(Vec3, Vec3) -> View) -> usize {
    changes_in_a_turn_of(&fitted(fit), eye, view)
}

fn changes_in_a_turn_of(cascades: &Cascades, eye: Vec3, view: fn(Vec3, Vec3) -> View) -> usize {
    let light = sun();
    let mut last = Vec::new();
    let mut before: Option<Vec<FlatFrame>> = None;
    let mut changes = 0;
    for step in 0..64 {
        let angle = std::f32::consts::TAU * step as f32 / 64.0;
        let along = Vec3::new(angle.cos(), 0.4 * (3.0 * angle).sin(), angle.sin());
        let view = view(eye, along);
        let now = fit_cascades(&CascadesOf {
            last: &last,
            ..of(&view, &light, cascades)
        })
        .unwrap();
        last = placed(&now);
        let now = frames(&now);
        if let Some(before) = before {
            changes += now.iter().zip(&before).filter(|(a, b)| a != b).count();
        }
        before = Some(now);
    }
    changes
}

fn places() -> impl Iterator<Item = Vec3> {
    (0..40).map(|i| {
        let at = i as f32;
        Vec3::new((at * 1.7).sin(), (at * 0.9).cos(), (at * 2.3).sin()) * (1.0 + 12.0 * at)
    })
}

#[test]
fn a_camera_that_turns_in_place_changes_no_frame() {
    let normal = |eye, along| perspective(50.0, eye, along);
    let wide = |eye, along| perspective(170.0, eye, along);
    for eye in places() {
        assert_eq!(
            changes_in_a_turn(CascadeFit::Stable, eye, normal),
            0,
            "{eye}"
        );
        assert_eq!(changes_in_a_turn(CascadeFit::Stable, eye, wide), 0, "{eye}");
        assert_eq!(
            changes_in_a_turn(CascadeFit::Stable, eye, off_centre),
            0,
            "{eye}"
        );
    }
    // Just between two texels of the first cascade, too, as far as can be told.
    let (light, cascades) = (sun(), fitted(CascadeFit::Stable));
    let view = normal(Vec3::ONE, Vec3::X);
    let first = frames(&fit_cascades(&of(&view, &light, &cascades)).unwrap())[0];
    let texel = 2.0 / first.scale / SIZE as f32;
    for texels in 0..40 {
        let eye = (first.right + first.up) * (texels as f32 + 0.5) * texel;
        let cascades = Cascades {
            margin: 0.0,
            ..cascades
        };
        assert_eq!(changes_in_a_turn_of(&cascades, eye, normal), 0, "{eye}");
    }
    // The broken twin: a fit that goes by what is seen.
    assert!(changes_in_a_turn(CascadeFit::Tight, Vec3::ONE, normal) > 200);
}

/// What a camera does to the cascades of a light on its way: for each step and cascade, the frame and
/// the one before.
fn walk(
    cascades: &Cascades,
    view: fn(Vec3, Vec3) -> View,
    light_turns: f32,
) -> Vec<(FlatFrame, FlatFrame)> {
    let mut last = Vec::new();
    let mut before: Vec<FlatFrame> = Vec::new();
    let mut steps = Vec::new();
    for step in 0..300 {
        let step = step as f32;
        let light = DirectionalLight {
            toward_light: sun().toward_light + Vec3::X * light_turns * step,
        };
        let eye = Vec3::new(0.05 * step, 2.0 + (0.1 * step).sin(), 8.0 - 0.03 * step);
        let view = view(
            eye,
            Vec3::new((0.02 * step).sin(), -0.1, (0.02 * step).cos()),
        );
        let now = fit_cascades(&CascadesOf {
            last: &last,
            ..of(&view, &light, cascades)
        })
        .unwrap();
        last = placed(&now);
        let now = frames(&now);
        steps.extend(now.iter().copied().zip(before));
        before = now;
    }
    steps
}

/// How far a fixed point of the world is from whole texels away from where it was on the map, at most;
/// and how often the map moved, and its scale changed.
fn grid_motion(steps: &[(FlatFrame, FlatFrame)]) -> (f64, usize, usize) {
    let texels = |frame: &FlatFrame| {
        let from = DVec3::new(3.3, 0.7, -2.1) - frame.origin.as_dvec3();
        let scale = f64::from(frame.scale) * f64::from(SIZE) / 2.0;
        DVec3::new(
            frame.right.as_dvec3().dot(from) * scale,
            frame.up.as_dvec3().dot(from) * scale,
            0.0,
        )
    };
    let (mut off, mut moved, mut resized) = (0.0_f64, 0, 0);
    for (now, before) in steps {
        if now.scale != before.scale {
            resized += 1;
            continue;
        }
        moved += usize::from(now != before);
        let shift = texels(now) - texels(before);
        off = off.max((shift - shift.round()).abs().max_element());
    }
    (off, moved, resized)
}

#[test]
fn a_camera_that_walks_moves_stable_cascades_by_whole_texels() {
    let normal = |eye, along| perspective(50.0, eye, along);
    let cascades = Cascades {
        margin: 0.0,
        ..fitted(CascadeFit::Stable)
    };
    for view in [normal as fn(Vec3, Vec3) -> View, off_centre, orthographic] {
        let (off, moved, resized) = grid_motion(&walk(&cascades, view, 0.0));
        // What is left is the rounding of places to f32: here 1e-6 of 0.01.
        assert!(off < 1e-3, "{off} texels");
        assert!(moved > 300, "the maps follow: {moved}");
        assert_eq!(resized, 0);
    }
    // The broken twins: a light that turns takes the grid with it, and a tight fit changes in size.
    let (off, ..) = grid_motion(&walk(&cascades, normal, 1e-4));
    assert!(off > 0.01, "{off} texels");
    let (_, _, resized) = grid_motion(&walk(&fitted(CascadeFit::Tight), normal, 0.0));
    assert!(resized > 0);
}

#[test]
fn a_cascade_stays_until_the_camera_has_walked_its_margin() {
    let normal = |eye, along| perspective(50.0, eye, along);
    let moved = |margin| {
        let cascades = Cascades {
            margin,
            ..fitted(CascadeFit::Stable)
        };
        let steps = walk(&cascades, normal, 0.0);
        // Of the last cascade, which is 230 wide.
        let last: Vec<_> = steps.iter().skip(3).step_by(4).copied().collect();
        (grid_motion(&steps).1, grid_motion(&last).1)
    };
    let (all, last) = moved(1.0 / 32.0);
    assert!(all < 60 && last <= 4, "{all} {last}");
    let (all, last) = moved(0.0);
    assert!(all > 600 && last > 40, "{all} {last}");
}

#[test]
fn a_tight_fit_is_narrower_the_narrower_the_view_and_a_stable_one_is_not() {
    let light = sun();
    let widths = |fit, degrees| {
        let view = perspective(degrees, Vec3::ONE, Vec3::X);
        let cascades = fit_cascades(&of(&view, &light, &fitted(fit))).unwrap();
        frames(&cascades)
            .iter()
            .map(|frame| 2.0 / frame.scale)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        widths(CascadeFit::Stable, 60.0),
        widths(CascadeFit::Stable, 1.0)
    );
    for (tight, stable) in widths(CascadeFit::Tight, 60.0)
        .iter()
        .zip(widths(CascadeFit::Stable, 60.0))
    {
        assert!(*tight < 0.75 * stable, "{tight} {stable}");
    }
    for (narrow, wide) in widths(CascadeFit::Tight, 1.0)
        .iter()
        .zip(widths(CascadeFit::Tight, 60.0))
    {
        assert!(*narrow < wide, "{narrow} {wide}");
    }
}

#[test]
fn a_cascade_covers_no_more_than_casts_and_receives() {
    let light = sun();
    let house = LightBox {
        min: DVec3::splat(-5.0),
        max: DVec3::splat(5.0),
    };
    let yard = Bounds {
        min: Vec3::new(-1.0, 0.0, -1.0),
        max: Vec3::new(1.0, 0.1, 1.0),
    };
    for fit in FITS {
        let cascades = fitted(fit);
        let width = |eye: Vec3, casters, receivers, cascade: usize| {
            let view = perspective(50.0, eye, -eye);
            let fitted = fit_cascades(&CascadesOf {
                casters: Some(casters),
                receivers,
                ..of(&view, &light, &cascades)
            });
            fitted.unwrap()[cascade]
                .map
                .map(|(frame, _)| 2.0 / frame.scale)
        };
        let eye = Vec3::new(0.0, 2.0, 20.0);
        let all = width(eye, EVERYWHERE, None, 3).unwrap();
        let few = width(eye, house, None, 3).unwrap();
        let fewest = width(eye, house, Some(yard), 3).unwrap();
        assert!(all > 60.0, "{all}");
        // A step and what is to spare are at most 1.19 * 1.1.
        assert!((10.0..13.1).contains(&few), "{few}");
        assert!((2.0..3.7).contains(&fewest), "{fewest}");
        // The first cascade reaches no house from here.
        assert!(width(eye, EVERYWHERE, None, 0).is_some());
        assert_eq!(width(eye, house, None, 0), None);
        let view = perspective(50.0, eye, -eye);
        let nothing = CascadesOf {
            casters: None,
            ..of(&view, &light, &cascades)
        };
        assert_eq!(fit_cascades(&nothing), Ok(Vec::new()));
    }
    // A camera that walks about the house changes no size in the stable fit.
    let view = |eye: Vec3| perspective(50.0, eye, Vec3::X);
    let cascades = fitted(CascadeFit::Stable);
    let scales = (0..50).map(|step| {
        let view = view(Vec3::new(
            -9.0 + 0.3 * step as f32,
            1.0,
            -8.0 + 0.3 * step as f32,
        ));
        let of = CascadesOf {
            casters: Some(house),
            ..of(&view, &light, &cascades)
        };
        frames(&fit_cascades(&of).unwrap())
            .iter()
            .map(|frame| frame.scale)
            .collect::<Vec<_>>()
    });
    let scales: Vec<Vec<f32>> = scales.collect();
    assert!(scales.iter().all(|scale| *scale == scales[0]), "{scales:?}");
}

#[test]
fn casters_before_the_near_plane_are_pulled_onto_it_where_that_can_be() {
    let light = sun();
    let along = LightAxes::of(&light).exact[2];
    // Where they are does not matter: they are all around what is seen.
    let tall = Bounds {
        min: Vec3::splat(-500.0),
        max: Vec3::splat(500.0),
    };
    for fit in FITS {
        let cascades = fitted(fit);
        for view in views(Vec3::new(3.0, 2.0, 1.0), Vec3::new(0.3, -0.4, 1.0)) {
            for (unclipped_depth, receivers) in [(true, None), (true, Some(tall)), (false, None)] {
                let mut of = of(&view, &light, &cascades);
                (of.shape.unclipped_depth, of.receivers) = (unclipped_depth, receivers);
                for cascade in fit_cascades(&of).unwrap() {
                    let (frame, _) = cascade.map.unwrap();
                    let near = along.dot(frame.origin.as_dvec3());
                    let far = near + f64::from(frame.range);
                    assert!(far > EVERYWHERE.max.z);
                    let nearest = points(&view, &cascade.slice)
                        .into_iter()
                        .map(|point| along.dot(point) - near)
                        .fold(f64::INFINITY, f64::min);
                    let width = 2.0 / f64::from(frame.scale);
                    let before_all = near < EVERYWHERE.min.z;
                    assert!(before_all || nearest > 16.0 * width, "{nearest} of {width}");
                    assert!(unclipped_depth || before_all);
                    // The broken twin: nearer than it has to be. (A sphere is so by its own size.)
                    let around = match fit {
                        CascadeFit::Stable => 2.0 * cascade.slice.to.max(120.0),
                        CascadeFit::Tight => 0.02 * cascade.slice.to,
                    };
                    assert!(before_all || nearest < 19.1 * width + around);
                }
            }
        }
    }
}

#[test]
fn one_map_is_one_cascade() {
    let light = sun();
    // So narrow that there is no difference between the distance from the eye and along the axis.
    let view = perspective(0.5, Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z);
    let cascades = Cascades {
        count: 1,
        margin: 0.0,
        distance: 40.0,
        ..fitted(CascadeFit::Tight)
    };
    let of = of(&view, &light, &cascades);
    let one = frames(&fit_cascades(&of).unwrap());
    let fit = |distance| {
        let fit = Fit {
            light: &light,
            view: Some((&view, distance)),
            receivers: None,
            shape: of.shape,
            casters: of.casters,
            last: None,
        };
        fit_directional(&fit).unwrap().0
    };
    let differ = |a: FlatFrame, b: FlatFrame| {
        let texel = 2.0 / a.scale / SIZE as f32;
        (a.origin - b.origin).length() / texel + (a.scale / b.scale - 1.0).abs()
    };
    assert!(
        differ(one[0], fit(40.0)) < 1.5,
        "{:?} {:?}",
        one[0],
        fit(40.0)
    );
    assert!(differ(one[0], fit(30.0)) > 20.0);
}

#[test]
fn what_receives_is_covered_with_the_reach_to_spare() {
    let light = sun();
    let view = perspective(120.0, Vec3::ZERO, Vec3::X);
    for fit in FITS {
        let cascades = Cascades {
            count: 1,
            margin: 0.0,
            ..fitted(fit)
        };
        let least = (0..200).map(|step| {
            let half = Vec3::splat((f32::from(step as u8) / 800.0).exp2());
            let middle = Vec3::X * 30.0;
            let of = CascadesOf {
                receivers: Some(Bounds {
                    min: middle - half,
                    max: middle + half,
                }),
                shape: shape(Radius::World(0.7)),
                ..of(&view, &light, &cascades)
            };
            let (frame, _) = fit_cascades(&of).unwrap()[0].map.unwrap();
            let texel = 2.0 / f64::from(frame.scale) / f64::from(SIZE);
            let corners =
                [-1.0, 1.0].map(|x| [-1.0, 1.0].map(|y| [-1.0, 1.0].map(|z| Vec3::new(x, y, z))));
            let corners = corners.as_flattened().as_flattened();
            let spare = corners.iter().map(|corner| {
                let corner = (middle + half * corner).as_dvec3();
                spare(&frame, corner) - 12.0 - f64::from(0.7_f32) / texel
            });
            spare.fold(f64::INFINITY, f64::min)
        });
        let least = least.fold(f64::INFINITY, f64::min);
        assert!((0.499..2.6).contains(&least), "{fit:?}: {least}");
    }
}

#[test]
fn far_from_the_origin_cascades_still_cover_their_slices() {
    let light = sun();
    // What f32 tells apart there is up to 20 texels wide.
    for (fit, far) in FITS
        .into_iter()
        .flat_map(|fit| [1e4, 1e6, 3e7].map(|far| (fit, far)))
    {
        let far: f32 = far;
        let eye = Vec3::new(far, 0.3 * far, -far);
        let view = perspective(50.0, eye, LightAxes::of(&light).rounded[0]);
        let casters = LightBox {
            min: DVec3::splat(-1.5 * f64::from(far)),
            max: DVec3::splat(1.5 * f64::from(far)),
        };
        let least = (0..100).map(|step| {
            let cascades = Cascades {
                count: 1,
                distance: 70.0 * (f32::from(step as u8) / 400.0).exp2(),
                margin: 0.0,
                ..fitted(fit)
            };
            let of = CascadesOf {
                casters: Some(casters),
                ..of(&view, &light, &cascades)
            };
            least_spare(&of, &cascades)
        });
        let least = least.fold(f64::INFINITY, f64::min);
        assert!(least > 0.0, "{fit:?} {far}: {least}");
    }
}

#[test]
fn what_is_out_of_range_is_named() {
    let light = sun();
    let view = perspective(50.0, Vec3::ONE, Vec3::X);
    let error = |cascades: &Cascades| fit_cascades(&of(&view, &light, cascades)).unwrap_err();
    let sound = Cascades::default();
    for count in [0, 9, u32::MAX] {
        let error = error(&Cascades { count, ..sound });
        assert_eq!(error, CascadeError::Count { count, limit: 8 });
    }
    for value in [-0.1, 1.5, f32::NAN, f32::INFINITY] {
        let split = CascadeSplit::Practical { lambda: value };
        let wrong = [
            ("lambda", Cascades { split, ..sound }),
            (
                "blend",
                Cascades {
                    blend: value,
                    ..sound
                },
            ),
            (
                "margin",
                Cascades {
                    margin: value,
                    ..sound
                },
            ),
        ];
        for (name, cascades) in wrong {
            let said = error(&cascades);
            let CascadeError::Share { field, .. } = said else {
                panic!("{said}");
            };
            assert!(field.ends_with(name), "{field}");
        }
    }
    for distance in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let error = error(&Cascades { distance, ..sound });
        assert!(matches!(error, CascadeError::Distance(_)), "{error}");
    }
    for (nearest, farthest) in [
        (-1.0, 2.0),
        (3.0, 2.0),
        (f32::NAN, 2.0),
        (0.0, f32::INFINITY),
    ] {
        let depth_bounds = Some(DepthBounds { nearest, farthest });
        let error = fit_cascades(&CascadesOf {
            depth_bounds,
            ..of(&view, &light, &sound)
        });
        assert!(matches!(error, Err(CascadeError::DepthBounds { .. })));
    }
    // All casters are too far away together.
    let casters = LightBox {
        min: DVec3::splat(-1e39),
        max: DVec3::splat(1e39),
    };
    let error = fit_cascades(&CascadesOf {
        casters: Some(casters),
        ..of(&view, &light, &sound)
    });
    assert_eq!(error, Err(CascadeError::BeyondF32 { cascade: 0 }));
}

#[test]
fn a_size_that_an_error_asks_for_is_enough() {
    let light = sun();
    let view = perspective(50.0, Vec3::ONE, Vec3::X);
    for (reach, margin) in [(12.0, 0.0), (12.0, 1.0 / 32.0), (64.0, 0.125), (1.0, 0.001)] {
        let cascades = Cascades {
            margin,
            ..Default::default()
        };
        let fit = |size| {
            fit_cascades(&CascadesOf {
                shape: MapShape {
                    size,
                    reach: Radius::Texels(reach),
                    unclipped_depth: true,
                },
                ..of(&view, &light, &cascades)
            })
        };
        let small = 4;
        let said = fit(small).unwrap_err();
        let asked = match said {
            CascadeError::ReachOfSize { .. } => said.to_string(),
            _ => panic!("{said}"),
        };
        let asked = asked.split("at least ").nth(1).unwrap();
        let asked: u32 = asked.split(' ').next().unwrap().parse().unwrap();
        assert!(fit(asked).is_ok(), "{asked}");
        assert!(fit(asked - asked / 16 - 2).is_err(), "{asked}");
    }
}
