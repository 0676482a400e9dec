//! The comparison against counts made by hand.

use shadows::HomogeneousLight;
use shadows::glam::{DVec3, Vec2, Vec3};
use shadows::reference::{
    Class, Interior, ReferenceImage, ReferenceObject, ReferenceScene, Verdict,
};

use crate::scene::{EYE, SIDE, downward, from_above, ground, ground_under, rectangle, sphere};

/// Ground only is seen (the roof is nearer than the near plane), with the roof's square shadow.
fn square_shadow() -> ReferenceImage {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    scene
        .render(&downward(EYE, 7.5), SIDE, SIDE, light, None)
        .unwrap()
}

fn inverted(image: &ReferenceImage) -> Vec<u8> {
    image.visibility().iter().map(|byte| 255 - byte).collect()
}

#[test]
fn the_truth_has_no_error_and_its_inverse_has_every() {
    let image = square_shadow();
    let (lit, shadowed) = (image.count(Class::Lit), image.count(Class::Shadowed));
    assert!(lit > 1000 && shadowed > 1000);
    let right = image
        .compare(&image.visibility(), Interior::Screen)
        .unwrap();
    assert_eq!(
        (right.false_lit, right.false_shadow, right.rmse),
        (0, 0, 0.0)
    );
    let wrong = image.compare(&inverted(&image), Interior::Screen).unwrap();
    assert_eq!((wrong.false_lit, wrong.false_shadow), (shadowed, lit));
    assert_eq!((wrong.lit_facing, wrong.rmse), (lit + shadowed, 1.0));
}

#[test]
fn half_is_lit_and_fractions_enter_the_rmse() {
    let image = square_shadow();
    let pixels = (SIDE * SIDE) as usize;
    let (lit, shadowed) = (image.count(Class::Lit), image.count(Class::Shadowed));
    let compare = |value: f32| {
        image
            .compare(&vec![value; pixels], Interior::Screen)
            .unwrap()
    };
    let quarter = compare(0.25);
    assert_eq!((quarter.false_lit, quarter.false_shadow), (0, lit));
    let square = lit as f64 * 0.5625 + shadowed as f64 * 0.0625;
    assert!((quarter.rmse - (square / pixels as f64).sqrt()).abs() < 1e-12);
    assert_eq!(compare(0.5).false_lit, shadowed);
    assert_eq!(compare(0.5_f32.next_down()).false_lit, 0);
    let bytes = |byte: u8| {
        image
            .compare(&vec![byte; pixels], Interior::Screen)
            .unwrap()
    };
    assert_eq!(bytes(128).false_lit, shadowed);
    assert_eq!(bytes(127).false_lit, 0);
}

/// Which pixels are in the interior, from the verdicts on a picture that is wrong everywhere.
fn interior(image: &ReferenceImage, interior: Interior) -> Vec<bool> {
    let error = image.compare(&inverted(image), interior).unwrap();
    let inside = |verdict: &Verdict| {
        matches!(
            verdict,
            Verdict::FalseLitInterior | Verdict::FalseShadowInterior
        )
    };
    let pixels: Vec<bool> = error.verdicts.iter().map(inside).collect();
    let count = pixels.iter().filter(|&&inside| inside).count();
    assert_eq!(
        count,
        error.false_lit_interior + error.false_shadow_interior
    );
    assert_eq!(count, image.interior_pixels(interior).unwrap());
    pixels
}

#[test]
fn the_screen_interior_is_where_the_neighbours_agree() {
    let image = square_shadow();
    let classes: Vec<Class> = image.classes().collect();
    let side = SIDE as i32;
    let agree = |i: usize, reach: i32| {
        let (x, y) = (i as i32 % side, i as i32 / side);
        (-reach..=reach).all(|dy| {
            (-reach..=reach).all(|dx| {
                let (x, y) = (x + dx, y + dy);
                !(0..side).contains(&x)
                    || !(0..side).contains(&y)
                    || classes[(y * side + x) as usize] == classes[i]
            })
        })
    };
    let inside = interior(&image, Interior::Screen);
    assert!((0..inside.len()).all(|i| inside[i] == agree(i, 1)));
    assert!(!(0..inside.len()).all(|i| inside[i] == agree(i, 2)));
}

#[test]
fn the_map_interior_is_as_far_from_the_edge_as_the_kernel_reaches() {
    let image = square_shadow();
    let screen = interior(&image, Interior::Screen);
    // The roof is 2 below the light and reaches 1 to each side: 0.5 on the cube face.
    let distance = |i: usize| {
        let point = ground_under(i as u32 % SIDE, i as u32 / SIDE, EYE);
        let (u, v) = ((point.x / 4.0).abs(), (point.z / 4.0).abs());
        if u < 0.5 && v < 0.5 {
            0.5 - u.max(v)
        } else {
            DVec3::new((u - 0.5).max(0.0), (v - 0.5).max(0.0), 0.0).length()
        }
    };
    let of_cube = |face_size: u32, kernel_radius: f32| {
        let map = Interior::Map {
            face_size,
            kernel_radius,
        };
        (
            map,
            (1.5 + f64::from(kernel_radius)) * 2.0 / f64::from(face_size),
        )
    };
    // Texels that lie on the ground, four times as far from the light as a cube's face.
    let of_light_map = |texel: f32| {
        let reach = 2.5 * 2.0_f64.sqrt() * f64::from(texel);
        (Interior::LightMap { texel }, reach / 4.0)
    };
    for (map, radius) in [
        of_cube(64, 0.0),
        of_cube(64, 2.5),
        of_cube(128, 6.5),
        of_light_map(0.05),
        of_light_map(0.2),
    ] {
        let inside = interior(&image, map);
        // Between the two the rays on a light map's rings may or may not find the edge; those of other maps
        // are beside it.
        let sure = match map {
            Interior::LightMap { .. } => 0.9,
            _ => 0.999,
        };
        let judge = |radius: f64| {
            let wrong = |&i: &usize| {
                let distance = distance(i);
                (inside[i] && distance < sure * radius)
                    || (!inside[i] && screen[i] && distance > radius)
            };
            (0..inside.len()).filter(wrong).count()
        };
        assert_eq!(judge(radius), 0, "{map:?}");
        assert!(
            judge(1.2 * radius) > 0 && judge(0.8 * radius) > 0,
            "{map:?}"
        );
        assert!(inside.iter().any(|&inside| inside));
    }
}

#[test]
fn the_edge_of_a_shadow_that_lies_beyond_the_range_is_one_for_maps() {
    // The shadow's sides are 2 from the middle, and in the middle of each the range ends 0.05 before them.
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    let range = Vec2::new(4.0, 1.95).length();
    let view = downward(EYE, 7.5);
    let image = scene.render(&view, SIDE, SIDE, light, Some(range)).unwrap();
    let map = Interior::Map {
        face_size: 64,
        kernel_radius: 0.0,
    };
    let (inside, screen) = (interior(&image, map), interior(&image, Interior::Screen));
    let radius = 4.0 * 1.5 * 2.0 / 64.0;
    let (mut near, mut far) = (0, 0);
    for (i, class) in image.classes().enumerate() {
        let point = ground_under(i as u32 % SIDE, i as u32 / SIDE, EYE);
        let away = 2.0 - point.x.abs().max(point.z.abs());
        if class == Class::Shadowed && screen[i] {
            let count = if away < 0.999 * radius {
                &mut near
            } else {
                &mut far
            };
            *count += 1;
            assert_eq!(inside[i], away > 0.999 * radius, "{point}, {away} away");
        }
    }
    assert!(near > 20 && far > 500, "{near}, {far}");
}

#[test]
fn a_shadow_and_a_gap_that_are_thinner_than_a_texel_are_edges() {
    // A hair that hangs where no pixel's own ray meets its shadow, and a roof with a slit there.
    let z = 0.1013_f32;
    let hair = rectangle(Vec2::new(-9.0, z), Vec2::new(9.0, z + 1e-3), 2.0);
    let halves = [
        rectangle(Vec2::new(-9.0, -9.0), Vec2::new(9.0, z), 2.0),
        rectangle(Vec2::new(-9.0, z + 1e-3), Vec2::new(9.0, 9.0), 2.0),
    ];
    let ground = ground();
    let light = HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0));
    let seen = |casters: &[ReferenceObject<'_>]| {
        let objects = [&[ground.object(false)], casters].concat();
        let scene = ReferenceScene::new(&objects).unwrap();
        let view = downward(EYE, 7.5);
        scene.render(&view, SIDE, SIDE, light, None).unwrap()
    };
    let images = [
        (seen(&[hair.object(true)]), Class::Lit),
        (
            seen(&halves.each_ref().map(|half| half.object(true))),
            Class::Shadowed,
        ),
    ];
    for (image, class) in images {
        assert!(image.classes().all(|own| own == class));
        let map = Interior::Map {
            face_size: 64,
            kernel_radius: 0.0,
        };
        let radius = 1.5 * 2.0 / 64.0;
        let inside = interior(&image, map);
        let mut near = 0;
        for (i, inside) in inside.iter().enumerate() {
            let point = ground_under(i as u32 % SIDE, i as u32 / SIDE, EYE);
            let away = (point.z / 4.0 - f64::from(z) / 2.0).abs();
            if away < 0.98 * radius {
                near += 1;
                assert!(!inside, "{class:?} at {point}, {away} away");
            }
        }
        assert!(near > 50 && inside.iter().any(|inside| *inside));
    }
}

#[test]
fn a_step_in_depth_is_an_edge_and_a_smooth_surface_has_none() {
    let ground = ground();
    let sun = HomogeneousLight::directional(Vec3::new(0.1, 1.0, 0.05));
    // A dome seen and lit from above, no shadow on it: everything in its outline is interior.
    let dome = sphere(Vec3::new(0.25, -30.0, 0.5), 36.0, 191, 256);
    let image = from_above(&[dome.object(true)], sun);
    let faces = image.lit_facing();
    assert_eq!(faces, (SIDE * SIDE) as usize);
    assert_eq!(image.interior_pixels(Interior::Screen).unwrap(), faces);

    // A sheet that does not cast, lit as the ground is: only its height makes an edge.
    let edges = |height| {
        let sheet = rectangle(Vec2::NEG_ONE, Vec2::ONE, height);
        let image = from_above(&[ground.object(false), sheet.object(false)], sun);
        assert_eq!(image.count(Class::Lit), image.lit_facing());
        image.lit_facing() - image.interior_pixels(Interior::Screen).unwrap()
    };
    // A pixel is 2 * 8 / 160 = 0.1 wide on the ground; a sheet 2 wide has 4 * 20 pixels of edge,
    // and as many around it.
    assert_eq!(edges(0.01), 0);
    let pixels = edges(0.5);
    assert!((140..200).contains(&pixels), "{pixels}");
}

#[test]
fn the_background_and_what_faces_away_bound_the_interior() {
    let sheet = rectangle(Vec2::NEG_ONE, Vec2::ONE, 0.0);
    let sun = HomogeneousLight::directional(Vec3::Y);
    let image = from_above(&[sheet.object(true)], sun);
    let lit = image.count(Class::Lit);
    let side = (lit as f64).sqrt().round() as usize;
    assert_eq!(side * side, lit);
    assert_eq!(
        image.interior_pixels(Interior::Screen).unwrap(),
        (side - 2).pow(2)
    );
    assert_eq!(
        image.coverage().iter().filter(|&&byte| byte == 255).count(),
        lit
    );
    assert_eq!(image.hit(0, 0), None);
    assert_eq!(image.hit(SIDE, 0), None);
}
