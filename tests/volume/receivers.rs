//! Volumes end behind what receives, and no shadow on it is lost.

use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Bounds;
use shadows::{HomogeneousLight, Method, ShadowVolumeRenderer, Silhouettes, VolumeStatistics};

use crate::choices::depths;
use crate::pictures::{at, lamp, sun};
use crate::shapes;
use crate::stage::{Body, Savings, Stage};
use host::gpu::Gpu;

/// Casters over and on the ground, one of them not closed.
fn casters() -> Vec<Body> {
    vec![
        Body::caster(shapes::sphere(8), at(-1.5, 1.6, 0.5)),
        Body::caster(shapes::cube().tilted(), at(2.0, 1.8, -1.0)),
        Body::caster(shapes::fins(3), at(0.5, 0.4, 2.5)),
    ]
}

fn drawn(gpu: &Gpu, stage: &Stage) -> (Vec<u8>, VolumeStatistics) {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let picture = stage.draw_with(gpu, &mut renderer, &stage.casters(gpu));
    (picture, renderer.statistics())
}

/// Right with the bounds of all that is there; as wrong as can be expected with those of the casters
/// alone, whose shadows the ground then has no part of.
fn assert_ends(gpu: &Gpu, stage: &Stage, what: &str) {
    let truth = stage.truth();
    let within = |bodies: &[Body]| Stage {
        receivers: Some(Stage::bounds(bodies)),
        ..stage.clone()
    };
    let (picture, statistics) = drawn(gpu, &within(&stage.bodies));
    let found = truth.errors(&picture);
    assert!(found.lit > 300 && found.shadowed > 300, "{what}: {found:?}");
    assert_eq!(found.wrong, 0, "{what}: {found:?}");
    match stage.savings.method {
        Method::ZFail => assert_eq!(statistics.casters_z_pass, 0, "{what}: {statistics:?}"),
        _ => assert!(statistics.casters_z_pass > 0, "{what}: {statistics:?}"),
    }
    let (broken, _) = drawn(gpu, &within(&stage.bodies[1..]));
    assert!(truth.errors(&broken).wrong > 50, "{what}");
}

#[test]
fn volumes_end_behind_the_receivers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let low = HomogeneousLight::point(Vec3::new(-9.0, 3.2, 4.0));
    let low_sun = HomogeneousLight::directional(Vec3::new(-3.0, 1.0, 0.4));
    for depth in depths(&gpu) {
        for (place, light) in [lamp(), sun(), low, low_sun].into_iter().enumerate() {
            for (method, silhouettes) in [
                (Method::Auto, Silhouettes::Auto),
                (Method::ZFail, Silhouettes::Compute),
                (Method::ZFail, Silhouettes::Vertex),
            ] {
                let stage = Stage {
                    depth,
                    savings: Savings {
                        method,
                        silhouettes,
                        ..Default::default()
                    },
                    ..Stage::new(light, casters())
                };
                assert_ends(
                    &gpu,
                    &stage,
                    &format!("{depth:?}, light {place}, {method:?}"),
                );
            }
        }
    }
}

#[test]
fn scenes_of_any_size_have_room_for_the_end() {
    let Some(gpu) = Gpu::for_test() else { return };
    for scale in [1e-4, 1e5] {
        for (light, method) in [(lamp(), Method::Auto), (sun(), Method::ZFail)] {
            let mut stage = Stage::new(light, casters());
            stage.savings.method = method;
            for body in &mut stage.bodies {
                body.transform = Affine3A::from_scale(Vec3::splat(scale)) * body.transform;
            }
            if !light.is_directional() {
                stage.light = HomogeneousLight::point(light.xyzw().truncate() * scale);
            }
            stage.eye *= scale;
            stage.target *= scale;
            stage.near *= scale;
            assert_ends(&gpu, &stage, &format!("scale {scale}, {light:?}"));
        }
    }
}

#[test]
fn an_eye_beyond_the_end_sees_the_same() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Shadows fall toward the eye, which looks back from beyond the table's edge.
    let low = HomogeneousLight::point(Vec3::new(-9.0, 3.2, -1.0));
    let low_sun = HomogeneousLight::directional(Vec3::new(-3.0, 1.0, -0.4));
    for light in [low, low_sun] {
        let mut stage = Stage::new(light, casters());
        stage.bodies[0].shape = shapes::square(4.5);
        stage.eye = Vec3::new(9.0, 4.0, 3.0);
        stage.receivers = Some(Stage::bounds(&stage.bodies));
        for method in [Method::Auto, Method::ZFail] {
            stage.savings.method = method;
            let found = stage.truth().errors(&stage.draw(&gpu));
            assert!(found.lit > 300 && found.shadowed > 300, "{found:?}");
            assert_eq!(found.wrong, 0, "{light:?}, {method:?}: {found:?}");
        }
    }
}

#[test]
fn casters_that_shadow_no_receiver_are_skipped() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Within sight, but its shadow falls beside everything else, which is far to the left.
    let mut stage = Stage::new(sun(), casters());
    stage.bodies[0].shape = shapes::square(4.5);
    stage.receivers = Some(Stage::bounds(&stage.bodies));
    let beside = Body::caster(shapes::cube(), at(6.5, 0.5, -4.0));
    let mut more = stage.clone();
    more.bodies.push(beside);
    let (_, statistics) = drawn(&gpu, &more);
    assert_eq!(
        (statistics.casters_drawn, statistics.skipped_out_of_view),
        (3, 1)
    );
    // The twin: on the other side, where the sun comes from, it shadows what is there.
    let last = more.bodies.len() - 1;
    more.bodies[last].transform = at(-7.0, 9.0, 4.0);
    let (_, statistics) = drawn(&gpu, &more);
    assert_eq!(
        (statistics.casters_drawn, statistics.casters_skipped),
        (4, 0)
    );
    // And where receivers may be anywhere, none is skipped.
    more.bodies[last].transform = at(6.5, 0.5, -4.0);
    more.receivers = None;
    let (_, statistics) = drawn(&gpu, &more);
    assert_eq!(
        (statistics.casters_drawn, statistics.casters_skipped),
        (4, 0)
    );
}

#[test]
fn flat_and_tiny_bounds_are_bounds() {
    let Some(gpu) = Gpu::for_test() else { return };
    for bounds in [
        Bounds {
            min: Vec3::new(-30.0, 0.0, -30.0),
            max: Vec3::new(30.0, 0.0, 30.0),
        },
        Bounds {
            min: Vec3::ZERO,
            max: Vec3::ZERO,
        },
    ] {
        for light in [lamp(), sun()] {
            let mut stage = Stage::new(light, casters());
            stage.receivers = Some(bounds);
            let (picture, _) = drawn(&gpu, &stage);
            let truth = stage.truth();
            if bounds.max.x > 0.0 {
                // Casters above a ground that alone receives shadow it all the same.
                assert_eq!(truth.errors(&picture).wrong, 0, "{light:?}");
            }
        }
    }
}
