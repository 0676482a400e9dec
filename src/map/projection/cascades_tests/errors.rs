//! What cascades refuse.

use super::*;

#[test]
fn what_is_out_of_range_is_named() {
    let light = sun();
    let view = perspective(50.0, Vec3::ONE, Vec3::X);
    let error = |cascades: &Cascades| cascades.validate().unwrap_err();
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
    for nearest in [-1.0, f32::NAN, f32::INFINITY] {
        let split = CascadeSplit::Ground { nearest };
        let error = error(&Cascades { split, ..sound });
        assert!(matches!(error, CascadeError::Nearest(_)), "{error}");
    }
    for (nearest, farthest) in [
        (-1.0, 2.0),
        (3.0, 2.0),
        (f32::NAN, 2.0),
        (0.0, f32::INFINITY),
    ] {
        let error = DepthBounds { nearest, farthest }.validate();
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
