//! The scene whose pixel count is published.

use shadows::glam::camera::rh;
use shadows::glam::{DAffine3, DVec3, Vec2, Vec3};
use shadows::reference::{Class, Comparison, Interior, ReferenceImage, ReferenceScene};
use shadows::{DepthConvention, HomogeneousLight, View};

use crate::scene::{rectangle, sphere};

/// The published scene: 64 spheres in a spiral over a ground.
fn spheres(light: Vec3) -> ReferenceImage {
    let ground = rectangle(Vec2::splat(-15.0), Vec2::splat(15.0), 0.0);
    let ball = sphere(Vec3::ZERO, 0.4, 24, 32);
    assert_eq!((ball.positions.len(), ball.indices.len()), (770, 3 * 1536));
    let mut objects = vec![ground.object(false)];
    for i in 0..64 {
        let r = 2.0 + 7.0 * ((f64::from(i) + 0.5) / 64.0).sqrt();
        let theta = 2.399963229728653 * f64::from(i);
        let y = 0.5 + 0.75 * f64::from(i % 4);
        let centre = DVec3::new(r * theta.cos(), y, r * theta.sin());
        objects.push(ball.at(DAffine3::from_translation(centre), true));
    }
    let scene = ReferenceScene::new(&objects).unwrap();
    let look = rh::view::look_at_mat4(Vec3::new(0.0, 9.0, 16.0), Vec3::new(0.0, 0.5, 0.0), Vec3::Y);
    let projection =
        rh::proj::directx::perspective_infinite_reverse(45_f32.to_radians(), 1280.0 / 720.0, 0.1);
    let view = View::new(projection * look, DepthConvention::InfiniteReverse).unwrap();
    let light = HomogeneousLight::point(light);
    scene.render(&view, 1280, 720, light, Some(30.0)).unwrap()
}

#[test]
fn the_published_scene_has_the_published_number_of_pixels() {
    let image = spheres(Vec3::Y * 4.0);
    let faces = image.lit_facing();
    println!("{faces} pixels face the light, {:.2} s", image.seconds());
    for class in [
        Class::Background,
        Class::Away,
        Class::OutOfRange,
        Class::Lit,
        Class::Shadowed,
    ] {
        println!("{class:?} {}", image.count(class));
    }
    assert!(faces.abs_diff(613_058) < 5, "{faces}");
    let error = measured(&image);
    assert_eq!(error.false_lit, image.count(Class::Shadowed));
    assert!(error.false_lit_interior < error.false_lit);
    let moved = spheres(Vec3::Y * 4.1).lit_facing();
    assert!(moved.abs_diff(613_058) >= 50, "{moved}");
}

fn measured(image: &ReferenceImage) -> Comparison {
    let start = std::time::Instant::now();
    let map = Interior::Map {
        face_size: 1024,
        kernel_radius: 0.0,
    };
    let error = image.compare(&vec![255_u8; 1280 * 720], map).unwrap();
    let (edge, inside) = (
        error.false_lit - error.false_lit_interior,
        error.false_lit_interior,
    );
    println!(
        "{edge} edge, {inside} interior pixels, {:.2} s",
        start.elapsed().as_secs_f64()
    );
    error
}
