use glam::camera::rh::{proj::directx as proj, view};
use glam::{DQuat, DVec3, Mat4, Vec3};

use super::*;
use crate::scene::CasterFilter;
use crate::volume::frame::VolumeCone;
use crate::{DepthConvention, HomogeneousLight, View};

const LIGHT: Vec3 = Vec3::new(2.0, 5.0, -1.0);
const RANGE: f32 = 7.0;

fn situation(cone: Option<VolumeCone>) -> Situation {
    let camera: Mat4 = view::look_at_mat4(Vec3::new(0.0, 3.0, 9.0), Vec3::ZERO, Vec3::Y);
    let projection = proj::perspective_infinite_reverse(0.9, 1.0, 0.1);
    Situation {
        light: HomogeneousLight::point(LIGHT),
        range: Some(RANGE),
        cone,
        filter: CasterFilter::ALL,
        views: vec![View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap()],
        target_size: None,
        receivers: None,
    }
}

fn cones() -> Vec<VolumeCone> {
    let directions = [
        Vec3::NEG_Y,
        Vec3::new(3.0, -1.0, 0.2),
        Vec3::new(-1e-3, 2e-3, 2e-3),
    ];
    let angles = [0.05, 0.6, 0.9, 1.56];
    let cone = |direction| {
        angles.map(|half_angle| VolumeCone {
            direction,
            half_angle,
        })
    };
    directions.into_iter().flat_map(cone).collect()
}

/// Points all over what the cone holds, those on its side and at the range among them.
fn reached(cone: VolumeCone) -> Vec<DVec3> {
    let axis = cone.direction.as_dvec3().normalize();
    let across = axis.any_orthonormal_vector();
    let mut points = vec![LIGHT.as_dvec3()];
    for turn in 0..24 {
        for step in 0..=6 {
            let tilt = f64::from(cone.half_angle) * f64::from(step) / 6.0;
            let around =
                DQuat::from_axis_angle(axis, f64::from(turn) * std::f64::consts::TAU / 24.0);
            let ray = axis * tilt.cos() + around * across * tilt.sin();
            let along = |part: f64| LIGHT.as_dvec3() + f64::from(RANGE) * part * ray;
            points.extend([0.02, 0.5, 1.0].map(along));
        }
    }
    points
}

fn speck(at: DVec3) -> WorldBox {
    WorldBox::new(at, DVec3::splat(1e-6))
}

#[test]
fn all_that_a_spot_reaches_is_in_its_ball_and_in_its_box() {
    for cone in cones() {
        let reach = Reach::new(&situation(Some(cone)));
        let (centre, radius) = reach.ball().unwrap();
        let [min, max] = reach.bounds().unwrap();
        let points = reached(cone);
        for point in &points {
            let is_in_box = point.cmpge(min - 1e-9).all() && point.cmple(max + 1e-9).all();
            assert!(is_in_box, "{cone:?}, {point}: {min}, {max}");
            assert!(point.distance(centre) < radius + 1e-9, "{cone:?}, {point}");
            assert!(!reach.misses(&speck(*point)), "{cone:?}, {point}");
        }
        // And neither is much larger than it must be.
        let most = |of: &dyn Fn(&DVec3) -> f64| points.iter().map(of).fold(0.0, f64::max);
        assert!(most(&|p| p.distance(centre)) > 0.99 * radius, "{cone:?}");
        let low = points.iter().copied().reduce(DVec3::min).unwrap();
        let high = points.iter().copied().reduce(DVec3::max).unwrap();
        let slack = 0.02 * f64::from(RANGE);
        assert!((low - min).max_element() < slack, "{cone:?}: {low}, {min}");
        assert!(
            (max - high).max_element() < slack,
            "{cone:?}: {high}, {max}"
        );
    }
}

#[test]
fn what_is_beside_the_cone_or_behind_it_is_missed() {
    for cone in cones() {
        let reach = Reach::new(&situation(Some(cone)));
        let axis = cone.direction.as_dvec3().normalize();
        let across = axis.any_orthonormal_vector();
        let at = |tilt: f64| {
            let ray = axis * tilt.cos() + across * tilt.sin();
            speck(LIGHT.as_dvec3() + 3.0 * ray)
        };
        let half_angle = f64::from(cone.half_angle);
        assert!(reach.misses(&at(half_angle + 2.0 * WIDER)), "{cone:?}");
        assert!(!reach.misses(&at(half_angle)), "{cone:?}");
        assert!(
            reach.misses(&speck(LIGHT.as_dvec3() - 3.0 * axis)),
            "{cone:?}"
        );
        // Within the cone, beyond the range.
        assert!(
            reach.misses(&speck(LIGHT.as_dvec3() + 7.1 * axis)),
            "{cone:?}"
        );
        // A box whose middle is beside the cone, but not all of it.
        let wide = WorldBox::new(LIGHT.as_dvec3() - axis, DVec3::splat(2.0));
        assert!(!reach.misses(&wide), "{cone:?}");
    }
}

#[test]
fn a_lamp_reaches_a_ball_and_the_sun_everything() {
    let lamp = Reach::new(&situation(None));
    let range = f64::from(RANGE);
    assert_eq!(lamp.ball(), Some((LIGHT.as_dvec3(), range)));
    let [min, max] = lamp.bounds().unwrap();
    assert_eq!((max - min) / (2.0 * range), DVec3::ONE);
    let sun = Reach::new(&Situation {
        light: HomogeneousLight::directional(Vec3::Y),
        ..situation(Some(cones()[0]))
    });
    assert!(sun.ball().is_none() && sun.bounds().is_none());
    assert!(!sun.misses(&speck(DVec3::new(0.0, 1e9, 0.0))));
}
