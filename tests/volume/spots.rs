//! Of what a light reaches every shadow is whole, and what is beside a spot's cone costs next to nothing.

use shadows::glam::{Affine3A, Vec3};
use shadows::{
    CasterState, Extrusion, HomogeneousLight, Method, ShadowVolumeRenderer, Silhouettes, VolumeCone,
};

use crate::choices::depths;
use crate::pictures::{at, lamp};
use crate::stage::{Body, Savings, Stage, WAYS};
use crate::{random, shapes};
use host::gpu::Gpu;
use host::random::Random;

/// Three in the middle of the cone, and one on its side.
fn casters() -> Vec<Body> {
    vec![
        Body::caster(shapes::sphere(8), at(-1.5, 1.6, 0.5)),
        Body::caster(shapes::cube().tilted(), at(1.2, 1.8, -1.0)),
        Body::caster(shapes::fins(3), at(0.5, 0.4, 2.5)),
        Body::caster(shapes::cube(), at(-3.6, 1.2, 4.0)),
    ]
}

fn spot(half_angle: f32) -> VolumeCone {
    VolumeCone {
        direction: Vec3::new(1.6, -6.0, -2.0),
        half_angle,
    }
}

fn stage(half_angle: f32) -> Stage {
    Stage {
        cone: Some(spot(half_angle)),
        range: Some(11.0),
        ..Stage::new(lamp(), casters())
    }
}

#[test]
fn all_shadows_within_a_cone_are_right() {
    let Some(gpu) = Gpu::for_test() else { return };
    for depth in depths(&gpu) {
        for (method, silhouettes) in [
            (Method::Auto, Silhouettes::Auto),
            (Method::ZFail, Silhouettes::Cpu),
            (Method::ZFail, Silhouettes::Vertex),
        ] {
            for half_angle in [0.3, 0.6, 1.1, 1.55] {
                let mut stage = stage(half_angle);
                stage.depth = depth;
                stage.savings.method = method;
                stage.savings.silhouettes = silhouettes;
                let what = format!("{depth:?}, {method:?}, {half_angle}");
                let truth = stage.truth();
                let found = truth.errors(&stage.draw(&gpu));
                assert!(found.lit > 300 && found.shadowed > 300, "{what}: {found:?}");
                assert_eq!(found.wrong, 0, "{what}: {found:?}");
                // The twin: volumes for a cone that looks elsewhere.
                stage.cone = Some(VolumeCone {
                    direction: Vec3::new(2.0, 6.0, -2.0),
                    half_angle,
                });
                let broken = truth.errors(&stage.draw(&gpu));
                assert!(broken.wrong > 50, "{what}: {broken:?}");
            }
        }
    }
}

#[test]
fn ends_on_the_sides_of_the_box_around_a_lamps_range_are_no_nearer_than_that() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Level with its casters, so that their shadows reach the box's sides before its floor.
    let level = HomogeneousLight::point(Vec3::new(-4.5, 1.9, 1.0));
    for depth in depths(&gpu) {
        for method in [Method::Auto, Method::ZFail] {
            let mut stage = Stage {
                depth,
                light: level,
                range: Some(9.0),
                ..Stage::new(level, casters())
            };
            stage.savings.method = method;
            let what = format!("{depth:?}, {method:?}");
            let truth = stage.truth();
            let found = truth.errors(&stage.draw(&gpu));
            assert!(found.lit > 300 && found.shadowed > 300, "{what}: {found:?}");
            assert_eq!(found.wrong, 0, "{what}: {found:?}");
            // The twin: an end that is too near.
            stage.range = Some(5.0);
            let broken = truth.errors(&stage.draw(&gpu));
            assert!(broken.wrong > 50, "{what}: {broken:?}");
        }
    }
}

#[test]
fn a_spot_skips_what_is_beside_its_cone_and_fills_less() {
    let Some(gpu) = Gpu::for_test() else { return };
    for silhouettes in WAYS {
        let measure = |cone: Option<VolumeCone>, unculled: bool| {
            let mut stage = stage(0.4);
            stage.cone = cone;
            stage.savings.silhouettes = silhouettes;
            stage.savings.unculled = unculled;
            let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
            stage.prepare(&gpu, &mut renderer, &stage.casters(&gpu));
            let fill = renderer.survey(0, 0, [stage.side; 2]).unwrap().fill();
            (renderer.caster_states(0, 0), fill)
        };
        let drawn = CasterState::ZPass;
        let (states, fill) = measure(Some(spot(0.4)), false);
        assert_eq!(states, [drawn, drawn, drawn, CasterState::OutOfRange]);
        // The last one is as near as the others, and is drawn all around; and where nothing is skipped.
        let (around, more) = measure(None, false);
        assert_eq!(around, [drawn; 4]);
        assert_eq!(measure(Some(spot(0.4)), true).0, [drawn; 4]);
        assert!(fill < 0.95 * more, "{fill}, {more}");
    }
}

/// Random scenes under spots that look at one of their casters.
fn scene(seed: u64, gpu: &Gpu) -> Option<Stage> {
    let mut stage = random::scene(seed, gpu);
    if stage.light.is_directional() {
        return None;
    }
    let random = &mut Random(seed ^ 0x5907);
    let place = stage.light.xyzw().truncate();
    let body = Vec3::from(stage.bodies[1].transform.translation);
    let direction = body + random.point(0.7) - place;
    stage.cone = Some(VolumeCone {
        direction: direction.normalize_or(Vec3::NEG_Y) * random.within(0.1, 9.0),
        half_angle: random.within(0.1, 1.57),
    });
    stage.range = stage.range.or(Some(random.within(5.0, 14.0)));
    Some(stage)
}

#[test]
fn random_scenes_are_exact_within_random_cones() {
    let Some(gpu) = Gpu::for_test() else { return };
    let [mut lit, mut shadowed, mut skipped] = [0_usize; 3];
    for seed in 0..160 {
        let Some(mut stage) = scene(seed, &gpu) else {
            continue;
        };
        let truth = stage.truth();
        for method in [Method::Auto, Method::ZFail] {
            stage.savings = Savings {
                method,
                silhouettes: WAYS[seed as usize % 3],
                ..Default::default()
            };
            let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
            let picture = stage.draw_with(&gpu, &mut renderer, &stage.casters(&gpu));
            let found = truth.errors(&picture);
            assert_eq!(found.wrong, 0, "seed {seed}, {method:?}: {found:?}");
            (lit, shadowed) = (lit + found.lit, shadowed + found.shadowed);
            skipped += renderer.statistics().skipped_out_of_range as usize;
        }
    }
    assert!(lit > 10_000 && shadowed > 10_000, "{lit}, {shadowed}");
    assert!(skipped > 20, "{skipped}");
}

#[test]
fn skipping_changes_no_bit_of_what_the_cone_holds() {
    let Some(gpu) = Gpu::for_test() else { return };
    // With volumes without end, so that nothing but what is drawn at all is another.
    let mut fewer = 0;
    for seed in 0..160 {
        let Some(mut stage) = scene(seed, &gpu) else {
            continue;
        };
        stage.savings.extrusion = Extrusion::Infinite;
        let picture = stage.draw(&gpu);
        let truth = stage.truth();
        let all_around = Stage {
            cone: None,
            ..stage.clone()
        }
        .draw(&gpu);
        let classes = truth.centres.classes();
        let pixels = classes.zip(picture.iter().zip(&all_around));
        for (class, (with, without)) in pixels {
            assert!(!class.faces_light() || with == without, "seed {seed}");
            fewer += usize::from(with != without);
        }
    }
    // Outside of it there are shadows that are not drawn.
    assert!(fewer > 1000, "{fewer}");
}

#[test]
fn a_light_that_reaches_no_receiver_draws_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut stage = stage(0.4);
    stage.receivers = Some(Stage::bounds(&stage.bodies));
    let drawn = |stage: &Stage| {
        let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
        stage.prepare(&gpu, &mut renderer, &stage.casters(&gpu));
        renderer.statistics().casters_drawn
    };
    assert_eq!(drawn(&stage), 3);
    // A hundred metres above, and so is what it shines at.
    stage.light = HomogeneousLight::point(lamp().xyzw().truncate() + 100.0 * Vec3::Y);
    let up = Affine3A::from_translation(100.0 * Vec3::Y);
    let ground = stage.bodies[0].clone();
    for body in &mut stage.bodies {
        body.transform = up * body.transform;
    }
    (stage.eye, stage.target) = (stage.eye + 100.0 * Vec3::Y, stage.target + 100.0 * Vec3::Y);
    assert_eq!(drawn(&stage), 0);
    // The twin: told of what is there.
    stage.bodies[0] = ground;
    stage.receivers = Some(Stage::bounds(&stage.bodies));
    assert_eq!(drawn(&stage), 3);
}

/// Hosts write so that a light is unlimited.
#[test]
fn a_range_beyond_all_that_f32_reckons_with_is_none() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut shadowed = 0;
    for seed in 0..24 {
        let mut stage = random::scene(seed, &gpu);
        if stage.light.is_directional() {
            continue;
        }
        stage.samples = 1;
        stage.receivers = None;
        stage.range = None;
        let truth = stage.truth();
        stage.range = Some(f32::MAX);
        for method in [Method::Auto, Method::ZFail] {
            let silhouettes = WAYS[seed as usize % WAYS.len()];
            stage.savings = Savings {
                method,
                silhouettes,
                ..Default::default()
            };
            let errors = truth.errors(&stage.draw(&gpu));
            assert_eq!(errors.wrong, 0, "seed {seed}, {method:?}: {errors:?}");
            shadowed += errors.shadowed;
        }
    }
    assert!(shadowed > 10_000, "{shadowed}");
}
