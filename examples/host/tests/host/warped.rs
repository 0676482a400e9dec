//! The warped map that others are measured against spends its texels as its authors say.

use host::scene::valley;
use host::warped::{Seen, warped};
use shadows::glam::{Vec3, Vec4Swizzles as _};
use shadows::mesh::Bounds;

#[test]
fn a_warped_map_holds_what_is_seen_and_gives_the_foreground_more() {
    let scene = valley();
    let bounds = scene.bounds();
    let bounds = Bounds {
        min: bounds.min.as_vec3(),
        max: bounds.max.as_vec3(),
    };
    let camera = &scene.camera;
    let forward = (camera.target - camera.eye).normalize();
    let far = (bounds.max - bounds.min).length();
    let clip_from_world = camera.clip_from_world(16.0 / 9.0);
    let seen = Seen {
        clip_from_world,
        nearest: None,
        far,
    };
    let light = scene.light().place.truncate();
    let map = warped(light, &seen, &bounds).unwrap();
    let in_map = |point: Vec3| {
        let clip = map * point.extend(1.0);
        clip.xyz() / clip.w
    };
    // What the camera sees of the bounds is in the map, and so is what is above it toward the light.
    let (mut inside, mut count) = (0, 0);
    let is_there = |point: Vec3| point.clamp(bounds.min, bounds.max) == point;
    for step in 1..200 {
        let point = camera.eye + forward * (0.005 * step as f32 * far);
        let at = in_map(point);
        count += usize::from(is_there(point));
        inside += usize::from(
            is_there(point)
                && at.truncate().abs().max_element() <= 1.0
                && (0.0..=1.0).contains(&at.z),
        );
        let toward = in_map(point + light.normalize() * 0.01 * far);
        assert!(toward.z < at.z && (toward - at).truncate().length() < 1e-3);
        // Whatever casts on it is between the map's two ends.
        let over = (1..1000).map(|metre| point + light.normalize() * metre as f32);
        for caster in over.take_while(|caster| is_there(*caster)) {
            let depth = in_map(caster).z;
            assert!((0.0..=1.0).contains(&depth), "{caster} {depth}");
        }
    }
    assert!(count > 10 && inside == count, "{inside} of {count}");
    // A metre near the camera has more of the map than a metre far away; without a warp as much.
    let length = |distance: f32| {
        let point = camera.eye + forward * distance;
        (in_map(point + forward) - in_map(point))
            .truncate()
            .length()
    };
    assert!(
        length(2.0) > 10.0 * length(0.3 * far),
        "{} {}",
        length(2.0),
        length(0.3 * far)
    );
}
