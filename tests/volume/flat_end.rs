//! Volumes that end in the very plane of a flat caster, seen from near by: z-fail counts the dark cap
//! behind the caster, however wrong f32 draws corners that are far away.

use shadows::glam::{Affine3A, Vec3};
use shadows::{HomogeneousLight, Method};

use crate::choices::depths;
use crate::pictures::{at, lamp};
use crate::shapes;
use crate::stage::{Body, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// A square in the ground that casts and bounds the receivers, and a sphere above it.
fn stage(light: HomogeneousLight, half: f32) -> Stage {
    let mut stage = Stage::new(
        light,
        vec![Body::caster(shapes::sphere(10), at(0.5, 1.6, 0.3))],
    );
    stage.bodies[0] = Body::caster(shapes::square(half), Affine3A::IDENTITY);
    stage.receivers = Some(Stage::bounds(&stage.bodies));
    stage.savings.method = Method::ZFail;
    stage
}

fn suns() -> [HomogeneousLight; 3] {
    [[-0.4, 1.0, 0.3], [0.9, 0.35, 0.1], [0.02, 1.0, -0.01]]
        .map(|toward| HomogeneousLight::directional(Vec3::from(toward)))
}

#[test]
fn a_flat_caster_in_the_receivers_own_side_shadows_nothing_above_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    for half in [300.0, 1e3, 3e3, 1e4, 1e5] {
        for light in suns() {
            let stage = stage(light, half);
            let truth = stage.truth();
            for silhouettes in WAYS {
                let savings = Savings {
                    silhouettes,
                    ..stage.savings
                };
                let stage = Stage {
                    savings,
                    ..stage.clone()
                };
                let found = truth.errors(&stage.draw(&gpu));
                let what = format!("{half}, {light:?}, {silhouettes:?}: {found:?}");
                assert!(found.lit > 10_000 && found.shadowed > 300, "{what}");
                assert_eq!(found.wrong, 0, "{what}");
            }
        }
    }
}

#[test]
fn so_it_is_in_every_depth_convention_and_under_a_lamp() {
    let Some(gpu) = Gpu::for_test() else { return };
    for depth in depths(&gpu) {
        for light in [lamp(), suns()[0]] {
            let stage = Stage {
                depth,
                near: 0.5,
                range: Some(40.0),
                ..stage(light, 1e3)
            };
            let found = stage.truth().errors(&stage.draw(&gpu));
            let what = format!("{depth:?}, {light:?}: {found:?}");
            assert!(found.interior > 10_000 && found.wrong == 0, "{what}");
        }
    }
}

/// The broken twin: receivers said to end above the ground, where volumes then end, too. The same
/// comparison finds that the sphere's shadow is missing from it.
#[test]
fn a_volume_that_ends_before_the_ground_is_found_out() {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in suns() {
        let mut stage = stage(light, 1e3);
        let truth = stage.truth();
        let mut bounds = stage.receivers.expect("the stage has bounds");
        bounds.min.y = 0.2;
        stage.receivers = Some(bounds);
        let found = truth.errors(&stage.draw(&gpu));
        assert!(found.wrong > 300, "{light:?}: {found:?}");
    }
}
