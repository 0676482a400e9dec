//! A light at a caster's skin: a millionth of the caster's size from it, or exactly on it.

use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{Caps, HomogeneousLight, Method};

use crate::pictures::at;
use crate::shapes::{self, Shape};
use crate::stage::{Body, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// A light at a place of the shape's own space, and beside the shape a small sphere.
fn stage(shape: &Shape, turn: Quat, light: Vec3) -> Stage {
    let place = at(0.0, 1.5, 0.0) * Affine3A::from_quat(turn);
    let small = Affine3A::from_scale(Vec3::splat(0.7));
    Stage::new(
        HomogeneousLight::point(place.transform_point3(light)),
        vec![
            Body::caster(shape.clone(), place),
            Body::caster(shapes::sphere(10), at(-1.5, 3.5, -1.0) * small),
        ],
    )
}

fn turns() -> [Quat; 2] {
    let axis = Vec3::new(1.0, 2.0, 3.0).normalize();
    [Quat::IDENTITY, Quat::from_axis_angle(axis, 0.4)]
}

fn assert_exact_every_way(gpu: &Gpu, stage: &Stage, what: &str) {
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
        let found = truth.errors(&stage.draw(gpu));
        let what = format!("{what}, {silhouettes:?}");
        assert!(found.shadowed > 10_000, "{what}: {found:?}");
        assert_eq!(found.wrong, 0, "{what}: {found:?}");
    }
}

/// Shapes of size 2 with a point of their skin and the way off it.
fn skins() -> [(&'static str, Shape, Vec3, Vec3); 6] {
    let (square, cube) = (shapes::square(1.0), shapes::cube());
    let open = cube.clone().cut(|c| !c.iter().all(|c| c.y < -0.5));
    [
        ("square", square.clone(), Vec3::new(0.1, 0.0, 0.2), Vec3::Y),
        (
            "square's diagonal",
            square,
            Vec3::new(0.1, 0.0, 0.1),
            Vec3::Y,
        ),
        ("cube", cube.clone(), Vec3::new(0.1, 1.0, 0.2), Vec3::Y),
        (
            "cube's edge",
            cube.clone(),
            Vec3::new(1.0, 1.0, 0.2),
            Vec3::new(1.0, 1.0, 0.0),
        ),
        ("cube's corner", cube, Vec3::ONE, Vec3::ONE),
        ("inside", open, Vec3::new(0.1, 1.0, 0.2), Vec3::NEG_Y),
    ]
}

#[test]
fn a_light_a_millionth_off_a_caster_casts_the_whole_shadow() {
    let Some(gpu) = Gpu::for_test() else { return };
    for (what, shape, foot, off) in skins() {
        for turn in turns() {
            let stage = stage(&shape, turn, foot + off * 1e-6);
            assert_exact_every_way(&gpu, &stage, &format!("{what}, {turn}"));
        }
    }
}

#[test]
fn a_millionth_to_the_other_side_is_another_picture() {
    let Some(gpu) = Gpu::for_test() else { return };
    for turn in turns() {
        let light = |height| stage(&shapes::square(1.0), turn, Vec3::new(0.1, height, 0.2));
        let below = light(-1e-6).draw(&gpu);
        assert!(light(1e-6).truth().errors(&below).wrong > 10_000);
    }
}

/// Far triangles are nearly singular there: a driver that clips them in f32 has them wrong, one that draws
/// homogeneous triangles whole need not. What the renderer takes is right on both.
#[test]
fn a_cap_that_is_a_fan_is_right_at_every_height() {
    let Some(gpu) = Gpu::for_test() else { return };
    let at_height = |height: f32| {
        let light = Vec3::new(0.1, height, 0.2);
        let mut stage = stage(&shapes::square(1.0), Quat::IDENTITY, light);
        stage.savings.method = Method::ZFail;
        stage
    };
    for height in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let mut stage = at_height(height);
        let truth = stage.truth();
        let fan = truth.errors(&stage.draw(&gpu));
        stage.savings.caps = Caps::Full;
        let full = truth.errors(&stage.draw(&gpu)).wrong;
        eprintln!(
            "{height:e}: a fan {}, far triangles {full} wrong",
            fan.wrong
        );
        assert!(
            fan.shadowed > 10_000 && fan.wrong == 0,
            "{height:e}: {fan:?}"
        );
        // The twin: a light as far below casts it elsewhere.
        let below = at_height(-height).draw(&gpu);
        assert!(truth.errors(&below).wrong > 10_000);
    }
}

#[test]
fn a_light_in_a_plane_on_a_vertex_or_on_an_edge_is_on_no_side() {
    let Some(gpu) = Gpu::for_test() else { return };
    for shape in [shapes::cube(), shapes::square(1.0)] {
        let top = shape
            .positions
            .iter()
            .fold(0.0, |top: f32, p| top.max(p[1]));
        for light in [[-1.0, 1.0], [0.0, 1.0], [0.3, 0.2], [2.5, 0.1]] {
            let light = Vec3::new(light[0], top, light[1]);
            let stage = stage(&shape, Quat::IDENTITY, light);
            let truth = stage.truth();
            for silhouettes in WAYS {
                let mut stage = stage.clone();
                stage.savings.silhouettes = silhouettes;
                let found = truth.errors(&stage.draw(&gpu));
                assert_eq!(found.wrong, 0, "{light}, {silhouettes:?}: {found:?}");
                assert!(found.lit > 300, "{found:?}");
            }
        }
    }
}

#[test]
fn a_light_inside_a_closed_caster_is_seen_nowhere_outside() {
    let Some(gpu) = Gpu::for_test() else { return };
    for shape in [shapes::cube(), shapes::sphere(8), shapes::cube().tilted()] {
        for light in [Vec3::new(0.1, 0.5, 0.2), Vec3::new(0.1, -0.9, 0.2)] {
            let stage = stage(&shape, Quat::IDENTITY, light);
            assert_exact_every_way(&gpu, &stage, &format!("{light}"));
        }
    }
}
