//! What is seen, and what the light reaches, against analytic answers.

use std::f32::consts::PI;

use shadows::glam::camera::{lh, rh};
use shadows::glam::{DVec3, Mat4, Vec2, Vec3, Vec4};
use shadows::reference::{Class, Interior, ReferenceImage, ReferenceScene};
use shadows::{DepthConvention, HomogeneousLight, SpotLight, View};

use crate::scene::{
    EYE, SIDE, crosses, disagreements, downward, from_above, furnished, ground, ground_under,
    lit_or, rectangle, sphere,
};

#[test]
fn a_rectangle_casts_its_projection() {
    let (low, high) = (Vec2::new(-1.0, -0.5), Vec2::new(1.5, 0.75));
    let (ground, roof) = (ground(), rectangle(low, high, 2.0));
    let (low, high) = (DVec3::new(-1.0, 2.0, -0.5), DVec3::new(1.5, 2.0, 0.75));
    let expected = |x, y, light: HomogeneousLight| {
        // Seen from above: the roof where the camera's ray crosses its plane inside it.
        let point = ground_under(x, y, EYE);
        let eye = EYE.as_dvec3();
        let at_roof = point + (eye - point) * (2.0 / eye.y);
        if at_roof.clamp(low, high) == at_roof.with_y(2.0) {
            return Some(Class::Lit);
        }
        let light = light.xyzw().as_dvec4();
        let to = light.truncate() - light.w * point;
        let crossing = (point + to * (2.0 / to.y)).with_y(2.0);
        Some(lit_or(crossing.clamp(low, high) == crossing))
    };
    for light in [
        HomogeneousLight::point(Vec3::new(0.3, 5.0, -0.7)),
        HomogeneousLight::point(Vec3::new(-3.0, 4.0, 1.0)),
        HomogeneousLight::directional(Vec3::new(0.5, 1.0, 0.27)),
    ] {
        let image = from_above(&[ground.object(false), roof.object(true)], light);
        assert!(image.count(Class::Shadowed) > 100);
        let (wrong, said) = disagreements(&image, |x, y| expected(x, y, light));
        assert_eq!((wrong, said), (0, (SIDE * SIDE) as usize), "{light:?}");
        // The twin: a light a little aside.
        let moved = HomogeneousLight::try_from(light.xyzw() + 0.1 * Vec4::X).unwrap();
        assert!(disagreements(&image, |x, y| expected(x, y, moved)).0 > 0);
    }
}

#[test]
fn a_spot_lights_a_disk_of_the_ground_below() {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let spot = SpotLight::new(Vec3::new(0.3, 3.0, -0.2), Vec3::NEG_Y * 7.0, 0.6, 30.0);
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(false)]).unwrap();
    let view = downward(EYE, 0.1);
    let image = scene.render_spot(&view, SIDE, SIDE, &spot).unwrap();
    let expected = |half_angle: f64| {
        move |x, y| {
            let point = ground_under(x, y, EYE);
            let eye = EYE.as_dvec3();
            let on_roof = point + (eye - point) * (2.0 / eye.y);
            // What a pixel sees is the roof where that is in the way.
            let at = match on_roof.x.abs() <= 1.0 && on_roof.z.abs() <= 1.0 {
                true => on_roof,
                false => point,
            };
            let along = at - spot.position.as_dvec3();
            let inside = along.angle_between(DVec3::NEG_Y) <= half_angle;
            Some(if inside {
                Class::Lit
            } else {
                Class::OutOfRange
            })
        }
    };
    let exact = f64::from(spot.half_angle);
    assert_eq!(disagreements(&image, expected(exact)).0, 0);
    assert!(image.count(Class::OutOfRange) > 100 && image.lit_facing() > 100);
    // The twin: a wider cone.
    assert!(disagreements(&image, expected(exact + 0.05)).0 > 0);
}

#[test]
fn the_penumbra_of_a_straight_edge_is_a_segment_of_the_disk() {
    // An edge half-way up to the light, along z.
    let roof = rectangle(Vec2::new(0.0, -20.0), Vec2::new(20.0, 20.0), 2.0);
    let ground = ground();
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    let eye = Vec3::new(0.0, 1.0, 0.0);
    let image = scene
        .render(&downward(eye, 0.1), SIDE, SIDE, light, None)
        .unwrap();
    let pixels: Vec<[u32; 2]> = (0..SIDE).map(|x| [x, SIDE / 2]).collect();
    let worst = |radius: f64, expected_radius: f64| {
        let seen = image.area_visibility(&pixels, radius, 1024);
        let errors = pixels.iter().zip(seen).map(|(&[x, y], seen)| {
            // The places of the disk on the other side of the edge.
            let t = (-ground_under(x, y, eye).x / expected_radius).clamp(-1.0, 1.0);
            let beyond = (t.acos() - t * (1.0 - t * t).sqrt()) / f64::from(PI);
            (seen.unwrap() - (1.0 - beyond)).abs()
        });
        errors.fold(0.0, f64::max)
    };
    assert!(worst(0.4, 0.4) < 0.02, "{}", worst(0.4, 0.4));
    // The twin: a smaller light.
    assert!(worst(0.3, 0.4) > 0.05);
    assert_eq!(image.area_visibility(&[[0, SIDE]], 0.4, 16), [None]);
}

#[test]
fn only_casters_cast() {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let light = HomogeneousLight::point(Vec3::new(2.0, 5.0, 0.0));
    let shadowed = |casts| {
        let image = from_above(&[ground.object(true), roof.object(casts)], light);
        assert_eq!(image.lit_facing(), (SIDE * SIDE) as usize);
        image.count(Class::Shadowed)
    };
    assert!(shadowed(true) > 0);
    assert_eq!(shadowed(false), 0);
}

#[test]
fn a_sphere_casts_between_its_inscribed_and_circumscribed_spheres() {
    let centre = Vec3::new(0.5, 2.0, 0.0);
    let (ball, ground) = (sphere(centre, 1.0, 47, 64), ground());
    let light = Vec3::new(2.0, 6.0, 1.0);
    let image = from_above(
        &[ground.object(false), ball.object(true)],
        HomogeneousLight::point(light),
    );
    // A facet is no farther from the centre than a step of latitude and one of longitude allow.
    let inner = (f64::from(PI) / 48.0).cos() * (f64::from(PI) / 64.0).cos();
    let expected = |radius: f64, x, y| {
        let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
        let light = light.as_dvec3();
        let along = (light - hit.position).normalize();
        let distance = (centre.as_dvec3() - hit.position).cross(along).length();
        if distance < inner * radius {
            Some(Class::Shadowed)
        } else if distance > radius {
            Some(Class::Lit)
        } else {
            None
        }
    };
    let (wrong, said) = disagreements(&image, |x, y| expected(1.0, x, y));
    assert_eq!(wrong, 0);
    assert!(said > 15_000, "{said}");
    assert!(disagreements(&image, |x, y| expected(1.05, x, y)).0 > 0);
    assert!(disagreements(&image, |x, y| expected(0.95, x, y)).0 > 0);
}

#[test]
fn the_far_side_is_away_and_shadows_itself_nowhere() {
    let ball = sphere(Vec3::new(0.0, 2.0, 0.0), 1.5, 24, 32);
    let light = HomogeneousLight::directional(Vec3::new(1.0, 0.5, 0.0));
    let image = from_above(&[ball.object(true)], light);
    // A convex body: what faces the light is lit.
    assert_eq!(image.count(Class::Shadowed), 0);
    assert!(image.count(Class::Away) > 100 && image.count(Class::Lit) > 100);
    for (i, class) in image.classes().enumerate() {
        let hit = image.hit(i as u32 % SIDE, i as u32 / SIDE);
        let faces = hit.map(|hit| hit.normal.dot(DVec3::new(1.0, 0.5, 0.0)) > 0.0);
        let expected = match faces {
            None => Class::Background,
            Some(true) => Class::Lit,
            Some(false) => Class::Away,
        };
        assert_eq!(class, expected);
    }
    // The twin: a second body makes the same surface shadowed.
    let other = sphere(Vec3::new(4.0, 4.0, 0.0), 1.5, 24, 32);
    assert!(from_above(&[ball.object(true), other.object(true)], light).count(Class::Shadowed) > 0);
}

#[test]
fn a_light_behind_or_in_the_plane_leaves_the_ground_away() {
    let ground = ground();
    let all = (SIDE * SIDE) as usize;
    for (height, class) in [(-3.0, Class::Away), (0.0, Class::Away), (3.0, Class::Lit)] {
        for light in [
            HomogeneousLight::point(Vec3::new(1.0, height, 2.0)),
            HomogeneousLight::directional(Vec3::new(1.0, height, 2.0)),
        ] {
            assert_eq!(from_above(&[ground.object(true)], light).count(class), all);
        }
    }
}

#[test]
fn beyond_the_range_is_another_class() {
    let (ground, position) = (ground(), Vec3::new(0.5, 3.0, 0.0));
    let scene = ReferenceScene::new(&[ground.object(false)]).unwrap();
    let light = HomogeneousLight::point(position);
    let image = scene
        .render(&downward(EYE, 0.1), SIDE, SIDE, light, Some(5.0))
        .unwrap();
    let expected = |x, y, range: f64| {
        let far = ground_under(x, y, EYE).distance(position.as_dvec3()) > range;
        Some(if far { Class::OutOfRange } else { Class::Lit })
    };
    assert_eq!(disagreements(&image, |x, y| expected(x, y, 5.0)).0, 0);
    assert!(disagreements(&image, |x, y| expected(x, y, 5.05)).0 > 0);
    assert!(image.count(Class::OutOfRange) > 0);
    assert_eq!(
        image.coverage().iter().filter(|&&byte| byte == 128).count(),
        image.count(Class::OutOfRange)
    );
    let sun = HomogeneousLight::directional(Vec3::Y);
    let image = scene
        .render(&downward(EYE, 0.1), SIDE, SIDE, sun, Some(5.0))
        .unwrap();
    assert_eq!(image.count(Class::OutOfRange), 0);
}

#[test]
fn all_projections_see_the_same_ground() {
    let [ground, resting, above, ..] = furnished();
    let scene = ReferenceScene::new(&[
        ground.object(false),
        resting.object(true),
        above.object(true),
    ])
    .unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.5, 3.0, -0.25));
    let look = rh::view::look_at_mat4(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO, Vec3::Y);
    let look_lh = lh::view::look_at_mat4(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO, Vec3::Y);
    let render = |matrix, depth| {
        let view = View::new(matrix, depth).unwrap();
        scene.render(&view, SIDE, SIDE, light, None).unwrap()
    };
    use DepthConvention as D;
    let perspective = [
        (
            rh::proj::directx::perspective_infinite_reverse(0.9, 1.0, 0.1) * look,
            D::InfiniteReverse,
        ),
        (
            rh::proj::directx::perspective(0.9, 1.0, 100.0, 0.1) * look,
            D::FiniteReverse,
        ),
        (
            rh::proj::directx::perspective(0.9, 1.0, 0.1, 100.0) * look,
            D::Standard,
        ),
        (
            lh::proj::directx::perspective(0.9, 1.0, 0.1, 100.0) * look_lh,
            D::Standard,
        ),
    ]
    .map(|(matrix, depth)| render(matrix, depth));
    // A left-handed camera shows world coordinates mirrored.
    let mut mirrored = perspective[0].visibility();
    mirrored.chunks_mut(SIDE as usize).for_each(<[u8]>::reverse);
    let truth = perspective[0].visibility();
    let errors = |image: &ReferenceImage, truth: &[u8]| {
        let error = image.compare(truth, Interior::Screen).unwrap();
        error.false_lit + error.false_shadow
    };
    // The f32 matrices differ in their last digits; a pixel on an edge may fall either way.
    let [_, finite, standard, left] = &perspective;
    for (image, truth, other) in [
        (finite, &truth, &mirrored),
        (standard, &truth, &mirrored),
        (left, &mirrored, &truth),
    ] {
        assert!(errors(image, truth) <= 2);
        assert!(errors(image, other) > 100);
    }
    let orthographic = rh::proj::directx::orthographic(-3.0, 3.0, -3.0, 3.0, 0.1, 30.0) * look;
    let image = render(orthographic, D::Standard);
    let (low, high) = (DVec3::new(-2.0, 0.0, -1.0), DVec3::new(-1.0, 1.0, 0.5));
    let (low2, high2) = (DVec3::new(1.0, 1.5, -1.0), DVec3::new(2.5, 2.0, 0.5));
    let expected = |x: u32, y: u32, eye: Vec3| {
        let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
        // Where the axis through the pixel meets the ground, from the camera's own axes.
        let back = eye.as_dvec3().normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let clip = |i: u32| 3.0 * ((2.0 * f64::from(i) + 1.0) / f64::from(SIDE) - 1.0);
        let start = right * clip(x) - up * clip(y);
        let point = start - back * (start.y / back.y);
        assert!(
            point.distance(hit.position) < 1e-5,
            "{point} {}",
            hit.position
        );
        let blocked = crosses(point, light, low, high) || crosses(point, light, low2, high2);
        Some(lit_or(blocked))
    };
    let (wrong, said) = disagreements(&image, |x, y| expected(x, y, Vec3::new(3.0, 4.0, 5.0)));
    assert!(wrong <= 2 && said > 10_000, "{wrong} of {said}");
    // The twin: the perspective picture is another one.
    assert!(errors(&image, &truth) > 100);
}

#[test]
fn the_near_and_far_planes_clip_what_is_seen_but_not_what_casts() {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    let seen = |near: f32, far: f32| {
        // Straight down, without glam's look_at, whose up must not be parallel to the view.
        let down = Mat4::from_cols(Vec4::X, Vec4::Z, -Vec4::Y, Vec4::new(0.0, 0.0, -8.0, 1.0));
        let matrix = rh::proj::directx::perspective(1.0, 1.0, near, far) * down;
        let view = View::new(matrix, DepthConvention::Standard).unwrap();
        let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
        let object = image.hit(SIDE / 2, SIDE / 2).map(|hit| hit.object);
        (object, image.count(Class::Shadowed))
    };
    let (object, with_roof) = seen(0.1, 20.0);
    assert_eq!(object, Some(1));
    let (object, without_roof) = seen(6.5, 20.0);
    assert_eq!(object, Some(0));
    assert!(without_roof > with_roof && with_roof > 0);
    assert_eq!(seen(0.1, 7.5), (Some(1), 0));
    assert_eq!(seen(0.1, 5.5), (None, 0));
}
