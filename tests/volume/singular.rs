//! Casters whose transforms flatten them: things that pop in, and all that are nearly flat.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{
    Caps, CasterState, HomogeneousLight, Method, ShadowVolumeRenderer, VolumeStatistics,
};

use crate::pictures::{at, lamp, sun};
use crate::shapes;
use crate::stage::{Body, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// A caster, and beside it one that is as it should be.
fn stage(light: HomogeneousLight, transform: Affine3A) -> Stage {
    let whole = Body::caster(shapes::sphere(12), at(2.0, 1.2, 0.5));
    let strange = Body::caster(shapes::cube(), at(-1.2, 1.4, 0.0) * transform);
    Stage::new(light, vec![strange, whole])
}

fn scale(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_scale(Vec3::new(x, y, z))
}

fn turn() -> Affine3A {
    Affine3A::from_quat(Quat::from_axis_angle(
        Vec3::new(1.0, 0.5, 0.3).normalize(),
        0.5,
    ))
}

/// Flat or as good as, and still of some area.
fn flat() -> Vec<(&'static str, Affine3A)> {
    vec![
        ("x and z of a box", scale(1.0, 0.0, 1.0)),
        ("turned, then flattened", scale(1.0, 0.0, 1.0) * turn()),
        ("flattened, then turned", turn() * scale(0.8, 0.0, 1.2)),
        ("by both", turn() * scale(1.0, 0.0, 1.0) * turn()),
        ("all but flat", turn() * scale(1.0, 1e-38, 1.0)),
        ("denormal", scale(1.0, 1e-42, 1.0)),
        ("inside out and thin", turn() * scale(1.0, -1e-12, 1.0)),
        (
            "so flat that f32 loses the light",
            scale(1.0, 1e-9, 1.0) * turn(),
        ),
    ]
}

/// Of no area at all.
fn gone() -> [(&'static str, Affine3A, u32); 4] {
    [
        ("nothing", scale(0.0, 0.0, 0.0), 1),
        ("a line", turn() * scale(0.0, 1.5, 0.0), 1),
        ("a line along an axis", scale(0.0, 1.5, 0.0) * turn(), 1),
        ("smaller than anything", scale(1e-38, 1e-38, 1e-38), 0),
    ]
}

/// The picture, and what the frame came to.
fn drawn(gpu: &Gpu, stage: &Stage) -> (Vec<u8>, VolumeStatistics) {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let picture = stage.draw_with(gpu, &mut renderer, &stage.casters(gpu));
    assert!(renderer.count_bound(0, 0) >= 1);
    (picture, renderer.statistics())
}

fn by(stage: &Stage, savings: Savings) -> Stage {
    Stage {
        savings,
        ..stage.clone()
    }
}

#[test]
fn a_flattened_caster_casts_the_shadow_of_what_is_left() {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in [lamp(), sun()] {
        for (what, transform) in flat() {
            let stage = stage(light, transform);
            let truth = stage.truth();
            for silhouettes in WAYS {
                for (method, caps) in [
                    (Method::Auto, Caps::AsNeeded),
                    (Method::ZFail, Caps::AsNeeded),
                    (Method::ZFail, Caps::Full),
                ] {
                    let savings = Savings {
                        silhouettes,
                        method,
                        caps,
                        ..Savings::default()
                    };
                    let (picture, statistics) = drawn(&gpu, &by(&stage, savings));
                    let found = truth.errors(&picture);
                    let what = format!("{what}, {light:?}, {savings:?}: {found:?}");
                    assert!(found.interior > 10_000, "{what}");
                    assert_eq!(found.wrong, 0, "{what}");
                    assert_eq!(statistics.casters_drawn, 2, "{what}");
                }
            }
            // Left out, its shadow is missed.
            let mut without = stage.clone();
            without.bodies[1].casts = false;
            let missed = truth.errors(&without.draw(&gpu));
            assert!(missed.wrong > 300, "{what}, {light:?}: {missed:?}");
        }
    }
}

#[test]
fn what_has_no_area_casts_nothing_and_everyone_else_what_they_did() {
    let Some(gpu) = Gpu::for_test() else { return };
    for light in [lamp(), sun()] {
        for (what, transform, skipped) in gone() {
            let stage = stage(light, transform);
            let mut alone = stage.clone();
            alone.bodies.remove(1);
            for silhouettes in WAYS {
                let savings = Savings {
                    silhouettes,
                    method: Method::ZFail,
                    ..Savings::default()
                };
                let (picture, statistics) = drawn(&gpu, &by(&stage, savings));
                let (right, _) = drawn(&gpu, &by(&alone, savings));
                assert!(picture == right, "{what}, {light:?}, {silhouettes:?}");
                assert_eq!(statistics.skipped_edge_on, skipped, "{what}");
                assert_eq!(statistics.casters_skipped, skipped, "{what}");
            }
        }
    }
}

#[test]
fn a_caster_flattened_to_a_plane_through_the_light_is_counted_and_left_out() {
    let Some(gpu) = Gpu::for_test() else { return };
    let level = HomogeneousLight::point(Vec3::new(-4.0, 1.4, 0.3));
    let stage = stage(level, scale(1.0, 0.0, 1.0));
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let picture = stage.draw_with(&gpu, &mut renderer, &stage.casters(&gpu));
    assert_eq!(stage.truth().errors(&picture).wrong, 0);
    assert_eq!(renderer.caster_states(0, 0)[0], CasterState::EdgeOn);
    assert_eq!(renderer.statistics().skipped_edge_on, 1);
}

#[test]
fn a_caster_that_pops_in_freezes_nothing() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut renderer = None;
    for size in [0.0, 1e-38, 1e-3, 1.0, 0.0] {
        let stage = stage(lamp(), scale(size, size, size));
        let renderer = renderer.get_or_insert_with(|| {
            ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap()
        });
        let picture = stage.draw_with(&gpu, renderer, &stage.casters(&gpu));
        let found = stage.truth().errors(&picture);
        assert!(
            found.shadowed > 300 && found.wrong == 0,
            "{size}: {found:?}"
        );
    }
}

#[test]
fn beyond_the_range_it_is_out_of_range_however_flat() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = stage(lamp(), at(500.0, 0.0, 0.0) * scale(1.0, 0.0, 1.0));
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let (view, casters) = (stage.view(), stage.casters(&gpu));
    let frame = OneLight {
        range: Some(50.0),
        ..OneLight::new(&view, stage.light, &casters)
    };
    renderer
        .prepare_one(&gpu.device, &gpu.queue, &frame)
        .unwrap();
    assert_eq!(renderer.caster_states(0, 0)[0], CasterState::OutOfRange);
}
