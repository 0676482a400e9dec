//! What a picture of the casters cannot know, held to what the pages say of it.

use super::ask::{Point, ask};
use super::{drawn, opaque};
use crate::common::shapes::{cuboid, square};
use host::gpu::Gpu;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Caster, DirectionalLight, Light, PointLight, ProjectedShadow, Projector, ProjectorState,
    SpotLight,
};

#[test]
fn a_caster_takes_its_own_shadow_from_the_nearest_point_of_its_bounds_on() {
    let Some(gpu) = Gpu::for_test() else { return };
    let caster = cuboid(Vec3::ONE).caster(&gpu.device, Affine3A::from_translation(Vec3::Y * 2.0));
    let casters = opaque(&[caster]);
    let light = DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2));
    let shadow = drawn(&gpu, &[Projector::new(light, &casters)]);
    // Its top faces the light, and all of it is taken for shadow but what is as near as the nearest corner.
    let top = |x: f32, z: f32| Point::at(Vec3::new(x, 3.0, z)).facing(Vec3::Y);
    let points = [top(0.0, 0.0), top(-0.9, -0.9), top(0.999, 0.999)];
    let seen = ask(&gpu, &shadow, 0, &points);
    assert_eq!(seen[..2], [[0.0; 3]; 2], "{seen:?}");
    // Above the box around it, nothing is.
    let above = ask(&gpu, &shadow, 0, &[Point::at(Vec3::new(0.3, 3.6, 0.2))]);
    assert_eq!(above, [[1.0; 3]]);
}

#[test]
fn a_receiver_between_caster_and_light_is_darkened_unless_its_projector_tells_them_apart() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = square(1.0).mesh(&gpu.device);
    let at = |y: f32, x: f32| {
        let place = Affine3A::from_translation(Vec3::new(x, y, 0.0));
        Caster::new(mesh.clone(), place)
    };
    let light = PointLight::new(Vec3::Y * 10.0, 100.0);
    // A shelf at height 5 above a low caster, both in the light's way; and another caster high up beside them.
    let (low, high) = (at(1.0, 0.0), at(6.0, 4.0));
    let shelf = [Point::at(Vec3::Y * 5.0)];
    let both = opaque(&[low.clone(), high.clone()]);
    let shadow = drawn(&gpu, &[Projector::new(light, &both)]);
    assert_eq!(ask(&gpu, &shadow, 0, &shelf), [[0.0; 3]], "falsely");
    let (low, high) = (opaque(&[low]), opaque(&[high]));
    let shadow = drawn(
        &gpu,
        &[Projector::new(light, &low), Projector::new(light, &high)],
    );
    let seen = [0, 1].map(|projector| ask(&gpu, &shadow, projector, &shelf)[0]);
    assert_eq!(seen, [[1.0; 3]; 2]);
}

#[test]
fn what_is_beyond_a_lights_range_casts_nothing_within_it() {
    let Some(gpu) = Gpu::for_test() else { return };
    let square = |half: f32, place: Vec3| square(half).caster(&gpu.device, at(place));
    fn at(place: Vec3) -> Affine3A {
        Affine3A::from_translation(place)
    }
    // Two small ones within the range of 8, and far behind the receivers a wide one, seen between them.
    let [left, right] = [-1.5, 1.5].map(|x| square(0.5, Vec3::new(x, 6.0, 0.0)));
    let far = square(9.0, Vec3::Y * -6.0);
    let casters = opaque(&[left, right, far]);
    let lights: [fn(f32) -> Light; 2] = [
        |range| PointLight::new(Vec3::Y * 10.0, range).into(),
        |range| SpotLight::new(Vec3::Y * 10.0, Vec3::NEG_Y, 0.5, range).into(),
    ];
    // Under a small one, and between the two.
    let points = [2.25, 0.0].map(|x| Point::at(Vec3::new(x, 4.0, 0.0)));
    let seen = |shadow: &ProjectedShadow| ask(&gpu, shadow, 0, &points);
    for light in lights {
        let shadow = drawn(&gpu, &[Projector::new(light(8.0), &casters)]);
        assert_eq!(seen(&shadow), [[0.0; 3], [1.0; 3]]);
        assert_eq!(shadow.statistics().triangles, 4);
        // The broken twin: a light that reaches both.
        let shadow = drawn(&gpu, &[Projector::new(light(40.0), &casters)]);
        assert_eq!(seen(&shadow), [[0.0; 3]; 2], "falsely");
        assert_eq!(shadow.statistics().triangles, 6);
        // With nothing in range there is no shadow.
        let shadow = drawn(&gpu, &[Projector::new(light(8.0), &casters[2..])]);
        assert_eq!(shadow.state(0), Some(ProjectorState::Empty));
    }
}

#[test]
fn a_light_among_its_casters_costs_that_shadow_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let at = |x: f32| {
        let place = Affine3A::from_translation(Vec3::new(x, 1.0, 0.0));
        cuboid(Vec3::splat(0.5)).caster(&gpu.device, place)
    };
    let around = opaque(&[at(-2.0), at(2.0)]);
    let beside = opaque(&[at(2.0)]);
    let light = PointLight::new(Vec3::Y, 100.0);
    let sun = DirectionalLight::new(Vec3::Y);
    let far = PointLight::new(Vec3::splat(1e37), 3e38);
    let projectors = [
        Projector::new(light, &around),
        Projector::new(light, &beside),
        Projector::new(far, &beside),
        Projector::new(sun, &[]),
        Projector::new(sun, &around),
    ];
    let shadow = drawn(&gpu, &projectors);
    let states: Vec<_> = (0..6).map(|projector| shadow.state(projector)).collect();
    let kept = Some(ProjectorState::Kept);
    let expected = [
        Some(ProjectorState::Surrounded),
        kept,
        Some(ProjectorState::BeyondF32),
        Some(ProjectorState::Empty),
        kept,
        None,
    ];
    assert_eq!(states, expected);
    let statistics = shadow.statistics();
    assert_eq!(
        (
            statistics.shadows_drawn,
            statistics.shadows_left_out,
            statistics.shadows_empty
        ),
        (2, 2, 1)
    );
    let point = [Point::at(Vec3::new(5.0, 1.0, 0.0))];
    let through = |projector| ask(&gpu, &shadow, projector, &point)[0];
    assert_eq!(
        [0, 1, 2, 3].map(through),
        [[1.0; 3], [0.0; 3], [1.0; 3], [1.0; 3]]
    );
    let under = [Point::at(Vec3::new(2.0, 0.0, 0.0))];
    assert_eq!(ask(&gpu, &shadow, 4, &under), [[0.0; 3]]);
}
