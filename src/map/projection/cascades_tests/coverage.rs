//! What each cascade covers.

use super::*;

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
        assert!(*tight < 0.9 * stable, "{tight} {stable}");
    }
    for (narrow, wide) in widths(CascadeFit::Tight, 1.0)
        .iter()
        .zip(widths(CascadeFit::Tight, 60.0))
    {
        assert!(*narrow < wide, "{narrow} {wide}");
    }
}

#[test]
fn a_stable_cascade_is_twice_as_wide_as_it_is_far_and_little_more() {
    let light = sun();
    let view = perspective(50.0, Vec3::ONE, Vec3::X);
    for distance in [30.0, 33.0, 36.0, 40.0, 700.0] {
        let cascades = Cascades {
            distance,
            margin: 0.0,
            ..fitted(CascadeFit::Stable)
        };
        let fitted = fit_cascades(&of(&view, &light, &cascades)).unwrap();
        for (cascade, frame) in fitted.iter().zip(frames(&fitted)) {
            let room = 1.0 - 2.0 * 13.25 / f64::from(SIZE);
            let over = 2.0 / f64::from(frame.scale) * room / (2.0 * cascade.slice.to);
            assert!((1.0..1.012).contains(&over), "{over}");
        }
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
fn a_tight_cascade_covers_of_what_receives_all_that_is_seen() {
    let light = sun();
    let cascades = Cascades {
        count: 4,
        margin: 0.0,
        ..fitted(CascadeFit::Tight)
    };
    // A low room, in which the views look up and down at an angle: most of what they show is not in it.
    let low = Bounds {
        min: Vec3::new(-900.0, 3.0, -900.0),
        max: Vec3::new(900.0, 9.0, 900.0),
    };
    let bounds = Some(DepthBounds {
        nearest: 2.0,
        farthest: 50.0,
    });
    let eye = Vec3::new(13.0, 7.0, 5.0);
    let mut outside = 0;
    for view in views(eye, Vec3::new(0.3, -0.4, 1.0)) {
        for depth_bounds in [None, bounds] {
            let of = CascadesOf {
                receivers: Some(low),
                depth_bounds,
                ..of(&view, &light, &cascades)
            };
            let fitted = fit_cascades(&of).unwrap();
            let inside = |point: &DVec3, low: &Bounds| {
                let point = point.as_vec3();
                point.cmpge(low.min).all() && point.cmple(low.max).all()
            };
            let forward = view.forward().normalize();
            let is_seen = |point: &DVec3| match (view.eye_point(), depth_bounds) {
                (Some(eye), Some(bounds)) => {
                    let depth = forward.dot(*point - eye);
                    (bounds.nearest.into()..=f64::from(bounds.farthest)).contains(&depth)
                }
                _ => true,
            };
            for cascade in &fitted {
                let received: Vec<DVec3> = dense_points(&view, &cascade.slice)
                    .into_iter()
                    .filter(|point| is_seen(point))
                    .collect();
                for point in received.iter().filter(|point| inside(point, &low)) {
                    let (frame, _) = cascade.map.unwrap();
                    assert!(spare(&frame, *point) > 12.499, "{view:?} {point}");
                }
                // The broken twin: what receives is higher than was said.
                let high = Bounds {
                    max: low.max + 60.0 * Vec3::Y,
                    min: low.min - 60.0 * Vec3::Y,
                };
                outside += received
                    .iter()
                    .filter(|point| inside(point, &high))
                    .filter(|point| {
                        let frame = cascade.map.map(|(frame, _)| frame);
                        frame.is_none_or(|frame| spare(&frame, **point) < 0.0)
                    })
                    .count();
            }
        }
    }
    assert!(outside > 16, "{outside}");
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
