//! Where rounding would show: contacts, edges, scale, lights on the geometry.

use shadows::HomogeneousLight;
use shadows::glam::{DAffine3, DVec3, Vec2, Vec3};
use shadows::reference::{Class, ReferenceScene};

use crate::scene::{
    EYE, Mesh, SIDE, crosses, cuboid, disagreements, downward, from_above, furnished, ground,
    ground_under, lit_or, rectangle,
};

#[test]
fn a_resting_box_leaves_no_light_gap() {
    let [ground, resting, ..] = furnished();
    for light in [
        HomogeneousLight::point(Vec3::new(1.0, 3.0, 0.3)),
        HomogeneousLight::directional(Vec3::new(1.0, 1.0, 0.3)),
    ] {
        let image = from_above(&[ground.object(true), resting.object(true)], light);
        let expected = |x, y, high: DVec3| {
            let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
            let low = DVec3::new(-2.0, 0.0, -1.0);
            Some(lit_or(crosses(hit.position.with_y(0.0), light, low, high)))
        };
        let high = DVec3::new(-1.0, 1.0, 0.5);
        let (wrong, said) = disagreements(&image, |x, y| expected(x, y, high));
        assert_eq!(wrong, 0);
        assert!(said > 15_000 && image.count(Class::Shadowed) > 40);
        let lower = high.with_y(0.9);
        assert!(disagreements(&image, |x, y| expected(x, y, lower)).0 > 0);
    }
}

#[test]
fn a_coplanar_copy_casts_nothing_and_a_lifted_one_everything() {
    let ground = ground();
    let light = HomogeneousLight::directional(Vec3::new(1.0, 0.01, 0.3));
    let turned = |lift: f64| {
        // There and back again, so that the corners round differently.
        let turn = DAffine3::from_axis_angle(DVec3::Y, 0.7);
        DAffine3::from_translation(DVec3::new(-1e3, lift, 3.0))
            * turn
            * DAffine3::from_translation(DVec3::new(300.0, 0.0, 700.0))
            * DAffine3::from_scale(DVec3::splat(1e3))
    };
    let shadowed = |lift| {
        let image = from_above(&[ground.object(true), ground.at(turned(lift), true)], light);
        assert_eq!(image.lit_facing(), (SIDE * SIDE) as usize);
        image.count(Class::Shadowed)
    };
    assert_eq!(shadowed(0.0), 0);
    // The twin: a copy that the near plane hides from view but not from the light.
    let scene = ReferenceScene::new(&[ground.object(true), ground.at(turned(1.0), true)]).unwrap();
    let image = scene
        .render(&downward(EYE, 7.5), SIDE, SIDE, light, None)
        .unwrap();
    assert_eq!(image.count(Class::Shadowed), image.lit_facing());
}

#[test]
fn a_sheet_a_ten_millionth_above_casts_its_shadow() {
    let height = 1e-7_f32;
    let sheet = rectangle(Vec2::new(0.0, -20.0), Vec2::new(20.0, 20.0), height);
    let ground = ground();
    let scene = ReferenceScene::new(&[ground.object(true), sheet.object(true)]).unwrap();
    let light = HomogeneousLight::directional(Vec3::new(1.0, 0.125, 0.0));
    let view = downward(EYE * 1e-6, 1e-7);
    let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
    let expected = |x, y, slope: f64| {
        let hit = image.hit(x, y).filter(|hit| hit.object == 0)?;
        Some(lit_or(
            hit.position.x > -f64::from(height) / slope && hit.position.x < 0.0,
        ))
    };
    let (wrong, said) = disagreements(&image, |x, y| expected(x, y, 0.125));
    assert!(wrong == 0 && said > 5_000, "{wrong} of {said}");
    assert!(image.count(Class::Shadowed) > 500);
    assert!(disagreements(&image, |x, y| expected(x, y, 0.15)).0 > 0);
}

#[test]
fn scale_and_place_change_nothing() {
    let meshes = furnished();
    let classes = |scale: f32, offset: Vec3, light: Vec3| -> Vec<Class> {
        let transform = DAffine3::from_translation(offset.as_dvec3())
            * DAffine3::from_scale(DVec3::splat(f64::from(scale)));
        let objects: Vec<_> = meshes.iter().map(|mesh| mesh.at(transform, true)).collect();
        let scene = ReferenceScene::new(&objects).unwrap();
        let view = downward(EYE * scale + offset, 0.1 * scale);
        let light = HomogeneousLight::point(light * scale + offset);
        let image = scene
            .render(&view, SIDE, SIDE, light, Some(9.0 * scale))
            .unwrap();
        image.classes().collect()
    };
    let light = Vec3::new(0.5, 3.0, -0.25);
    let original = classes(1.0, Vec3::ZERO, light);
    for class in [Class::Lit, Class::Shadowed, Class::Away, Class::OutOfRange] {
        assert!(original.contains(&class), "{class:?}");
    }
    for scale in [1e-4, 1e5] {
        assert!(classes(scale, Vec3::ZERO, light) == original, "{scale}");
    }
    for offset in [Vec3::splat(1e5), Vec3::new(-1e5, 1e3, 1e6)] {
        assert!(classes(1.0, offset, light) == original, "{offset}");
    }
    let aside = light + Vec3::X / 64.0;
    assert!(classes(1.0, Vec3::splat(1e5), aside) != original);
}

#[test]
fn a_light_on_a_vertex_on_an_edge_inside_and_in_the_plane() {
    let (low, high) = (Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 3.0, 1.0));
    let (ground, cube) = (ground(), cuboid(low, high));
    let render = |light| {
        let scene = ReferenceScene::new(&[ground.object(false), cube.object(true)]).unwrap();
        // The near plane at 0.25: the box is not seen, only its shadow.
        let view = downward(EYE, 7.75);
        scene
            .render(&view, SIDE, SIDE, HomogeneousLight::point(light), None)
            .unwrap()
    };
    type Shadow = fn(DVec3) -> bool;
    let cases: [(Vec3, Shadow); 4] = [
        (high, |p| p.x < 1.0 && p.z < 1.0),
        (Vec3::new(1.0, 3.0, 0.0), |p| p.x < 1.0),
        (Vec3::new(0.1, 2.0, 0.2), |_| true),
        (Vec3::new(0.0, 3.0, 0.0), |_| true),
    ];
    for (light, shadow) in cases {
        let image = render(light);
        let expected = |x, y| Some(lit_or(shadow(ground_under(x, y, EYE))));
        assert_eq!(disagreements(&image, expected).0, 0, "{light}");
        // The twin: the same light above the box.
        let above = render(light.with_y(4.0));
        assert!(disagreements(&above, expected).0 > 0, "{light}");
    }
    let roof = rectangle(Vec2::NEG_ONE, Vec2::ONE, 3.0);
    let shadowed = |light| {
        from_above(
            &[ground.object(false), roof.object(true)],
            HomogeneousLight::point(light),
        )
        .count(Class::Shadowed)
    };
    assert_eq!(shadowed(Vec3::new(0.5, 3.0, 0.0)), 0);
    assert!(shadowed(Vec3::new(0.5, 3.0 + 1e-6, 0.0)) > 10_000);
}

#[test]
fn no_ray_slips_through_a_shared_edge() {
    // Camera and light above the middle: the pixels with x = y look, and are lit, exactly along the
    // diagonals of the ground and of the roof.
    let (ground, roof) = (
        ground(),
        rectangle(Vec2::splat(-2.0), Vec2::splat(2.0), 2.0),
    );
    let half = Mesh {
        indices: vec![0, 1, 2],
        ..roof.clone()
    };
    let shadowed = |roof: &Mesh| {
        let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
        let light = HomogeneousLight::point(Vec3::Y * 4.0);
        let view = downward(Vec3::Y * 8.0, 7.5);
        let image = scene.render(&view, SIDE, SIDE, light, None).unwrap();
        assert_eq!(image.count(Class::Background), 0);
        image.count(Class::Shadowed)
    };
    // The roof reaches 2 to each side, its shadow 4, where a pixel is 0.1 wide.
    assert_eq!(shadowed(&roof), 80 * 80);
    // The diagonal belongs to each half.
    assert_eq!(shadowed(&half), 80 * 81 / 2);
    // And to triangles wound the other way.
    for mesh in [roof, half] {
        let mut flipped = mesh.clone();
        flipped.indices.reverse();
        assert_eq!(shadowed(&flipped), shadowed(&mesh));
    }
}

#[test]
fn degenerate_scenes_work() {
    let light = HomogeneousLight::point(Vec3::new(0.5, 3.0, -0.25));
    let all = (SIDE * SIDE) as usize;
    assert_eq!(from_above(&[], light).count(Class::Background), all);
    let none = Mesh {
        positions: vec![[0.0; 3]],
        indices: Vec::new(),
    };
    assert_eq!(
        from_above(&[none.object(true)], light).count(Class::Background),
        all
    );

    let [ground, resting, above, ..] = furnished();
    let mut bad = above.clone();
    bad.positions.push([1.0 + 1.5 / 1024.0, 1.5, -1.0]);
    bad.indices.extend([0, 0, 1, 3, 3, 3, 0, 8, 1]);
    let classes = |mesh: &Mesh| -> Vec<Class> {
        let objects = [
            ground.object(false),
            resting.object(true),
            mesh.object(true),
        ];
        from_above(&objects, light).classes().collect()
    };
    assert!(classes(&bad) == classes(&above));
    bad.indices.extend([0, 3, 100]);
    bad.positions.resize(101, [-3.0, 2.0, -3.0]);
    assert!(classes(&bad) != classes(&above));

    // One triangle a thousand times: as once.
    let once = Mesh {
        indices: vec![0, 1, 2],
        ..rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0)
    };
    let often = Mesh {
        indices: [0, 1, 2].repeat(1000),
        ..once.clone()
    };
    assert!(classes(&once) == classes(&often));
    let both = rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0);
    assert!(classes(&once) != classes(&both));
}
