//! Texture coordinates for light maps: every triangle has a place of its own, of its own size.

use host::scene::{floor, spheres};
use host::unwrap::Unwrapping;
use shadows::glam::{DVec2, DVec3};

#[test]
fn scenes_are_unwrapped_without_overlap_or_crowding() {
    for scene in [floor(), spheres()] {
        let unwrapping = Unwrapping::new(&scene, 256).unwrap();
        assert_eq!(unwrapping.layout.crowded_texels(), 0, "{}", scene.name);
        let filled = unwrapping.layout.covered_texels() as f64 / f64::from(256 * 256);
        assert!(filled > 0.4, "{}: {filled}", scene.name);
        let all = unwrapping
            .objects
            .iter()
            .map(|o| o.positions.len() / 3)
            .sum::<usize>();
        assert_eq!(all, scene.triangle_count());
    }
    let error = Unwrapping::new(&spheres(), 4)
        .err()
        .expect("4 texels a side are too few");
    assert!(error.to_string().contains("too few"), "{error}");
}

/// No triangle is stretched beyond what is said of the largest texel.
#[test]
fn texels_are_about_the_same_size_everywhere() {
    let scene = floor();
    let unwrapping = Unwrapping::new(&scene, 256).unwrap();
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
    for (object, placed) in unwrapping.objects.iter().zip(&scene.objects) {
        let texels = DVec2::new(
            object.rectangle.width.into(),
            object.rectangle.height.into(),
        );
        for (corners, uvs) in object
            .positions
            .chunks_exact(3)
            .zip(object.uvs.chunks_exact(3))
        {
            let [a, b, c]: [DVec3; 3] = [0, 1, 2].map(|k| placed.world_point(corners[k]));
            let area = (b - a).cross(c - a).length();
            let [a, b, c] = [0, 1, 2].map(|k| DVec2::from_array(uvs[k].map(f64::from)) * texels);
            let texels = (b - a).perp_dot(c - a).abs();
            let side = (area / texels).sqrt();
            (smallest, largest) = (smallest.min(side), largest.max(side));
        }
    }
    assert!(largest <= 1.001 * unwrapping.texel, "{largest}");
    assert!(smallest > 0.8 * unwrapping.texel, "{smallest} {largest}");
}
