//! What is cut out of triangles, and other lights on the same picture, against analytic answers.

use shadows::glam::{DVec3, Vec2, Vec3, Vec4};
use shadows::reference::{Class, Crossing, ReferenceImage, ReferenceScene};
use shadows::{HomogeneousLight, SpotLight};

use crate::scene::{
    EYE, SIDE, disagreements, downward, furnished, ground, ground_under, lit_or, rectangle,
};

/// A disk, cut out of a square roof.
const MIDDLE: DVec3 = DVec3::new(0.11, 2.0, -0.07);
const RADIUS: f64 = 0.83;

fn on_disk(point: DVec3) -> bool {
    point.distance(MIDDLE) <= RADIUS
}

#[test]
fn of_a_square_with_a_mask_only_what_the_mask_leaves_is_seen_and_casts() {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let corners = roof.positions.clone();
    let indices = roof.indices.clone();
    let mask = move |crossing: &Crossing| {
        let corner = |k: usize| {
            let index = indices[3 * crossing.triangle as usize + k];
            DVec3::from_array(corners[index as usize].map(f64::from)) * crossing.weights[k]
        };
        crossing.object != 1 || on_disk(corner(0) + corner(1) + corner(2))
    };
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let masked = scene.clone().with_opacity(mask);
    for light in [
        HomogeneousLight::point(Vec3::new(0.3, 5.0, -0.7)),
        HomogeneousLight::directional(Vec3::new(0.5, 1.0, 0.27)),
    ] {
        let expected = |x, y| {
            let (point, eye) = (ground_under(x, y, EYE), EYE.as_dvec3());
            if on_disk(point + (eye - point) * (2.0 / eye.y)) {
                return Some(Class::Lit);
            }
            let light = light.xyzw().as_dvec4();
            let to = light.truncate() - light.w * point;
            Some(lit_or(on_disk(point + to * (2.0 / to.y))))
        };
        let wrong = |scene: &ReferenceScene| {
            let view = downward(EYE, 0.1);
            let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
            assert!(image.count(Class::Shadowed) > 100);
            disagreements(&image, expected).0
        };
        assert_eq!(wrong(&masked), 0, "{light:?}");
        // The twin: the whole square.
        assert!(wrong(&scene) > 100, "{light:?}");
    }
}

#[test]
fn a_picture_under_another_light_is_as_if_it_were_made_anew() {
    let meshes = furnished();
    let objects = meshes.each_ref().map(|mesh| mesh.object(true));
    let scene = ReferenceScene::new(&objects).unwrap();
    let view = downward(EYE, 0.1);
    let render = |light: HomogeneousLight, range| {
        let image = scene.render(&view, SIDE, SIDE, light, range);
        image.unwrap()
    };
    let first = render(HomogeneousLight::point(Vec3::new(0.3, 5.0, -0.7)), None);
    let classes = |image: &ReferenceImage| -> Vec<Class> { image.classes().collect() };
    for (light, range) in [
        (
            HomogeneousLight::point(Vec3::new(-3.0, 4.0, 1.0)),
            Some(6.0),
        ),
        (
            HomogeneousLight::directional(Vec3::new(0.5, 1.0, 0.27)),
            None,
        ),
    ] {
        let relit = first.relit(light, range).unwrap();
        assert_eq!(classes(&relit), classes(&render(light, range)));
        let moved = HomogeneousLight::try_from(light.xyzw() + 0.1 * Vec4::X).unwrap();
        assert_ne!(classes(&relit), classes(&render(moved, range)));
    }
    let spot = SpotLight::new(Vec3::new(0.3, 3.0, -0.2), Vec3::NEG_Y, 0.6, 30.0);
    let relit = first.relit_by_spot(&spot).unwrap();
    let anew = scene.render_spot(&view, SIDE, SIDE, &spot).unwrap();
    assert_eq!(classes(&relit), classes(&anew));
    assert_ne!(classes(&relit), classes(&first));
    assert!(
        first
            .relit(HomogeneousLight::directional(Vec3::ZERO), None)
            .is_err()
    );
    assert!(
        first
            .relit(HomogeneousLight::point(Vec3::ONE), Some(0.0))
            .is_err()
    );
    let wrong = SpotLight {
        half_angle: 0.0,
        ..spot
    };
    assert!(first.relit_by_spot(&wrong).is_err());
}
