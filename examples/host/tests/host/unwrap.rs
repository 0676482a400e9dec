//! Texture coordinates for light maps: every triangle has a place of its own, of its own size.

use std::f32::consts::TAU;

use host::scene::{Mesh, Object, Scene, courtyard, floor, spheres};
use host::unwrap::Unwrapping;
use shadows::glam::{Affine3A, DVec2, DVec3};

/// Triangles on one another are refused by the layout that is made.
#[test]
fn scenes_are_unwrapped_without_overlap_or_crowding() {
    for (scene, side, least) in [
        (floor(), 256, 0.5),
        (spheres(), 512, 0.5),
        (courtyard(), 1024, 0.4),
    ] {
        let start = std::time::Instant::now();
        let unwrapping = Unwrapping::new(&scene, side).unwrap();
        let filled = unwrapping.layout.covered_texels() as f64 / f64::from(side) / f64::from(side);
        println!(
            "{}: {} charts, texels of {:.4} m, {filled:.2} filled, {:.2} s",
            scene.name,
            unwrapping.charts,
            unwrapping.texel,
            start.elapsed().as_secs_f64()
        );
        assert_eq!(unwrapping.layout.crowded_texels(), 0, "{}", scene.name);
        assert!(filled > least, "{}: {filled}", scene.name);
        let objects = unwrapping.objects.iter();
        let all: usize = objects.map(|object| object.positions.len() / 3).sum();
        assert_eq!(all, scene.triangle_count());
    }
}

/// The twin: without a gap a filter reads what is beside a chart.
#[test]
fn charts_without_gaps_are_crowded() {
    let unwrapping = Unwrapping::with_gap(&floor(), 256, 0).unwrap();
    let crowded = unwrapping.layout.crowded_texels();
    assert!(crowded > 1_000, "{crowded}");
}

#[test]
fn too_few_texels_are_refused() {
    let error = Unwrapping::new(&spheres(), 4)
        .err()
        .expect("4 texels a side are too few");
    assert!(error.to_string().contains("too few"), "{error}");
}

/// Two turns of a ramp lie over one another, with no two triangles that face farther apart than a chart allows.
#[test]
fn a_chart_that_folds_over_itself_is_divided() {
    let (steps, turns) = (128, 2.0);
    let mut mesh = Mesh {
        name: "ramp".into(),
        positions: Vec::new(),
        normals: Vec::new(),
        indices: Vec::new(),
        mask: Vec::new(),
    };
    for step in 0..=steps {
        let part = step as f32 / steps as f32;
        let (sine, cosine) = (TAU * turns * part).sin_cos();
        for radius in [2.0, 3.0] {
            let at = [radius * cosine, 1.0 * part, radius * sine];
            mesh.positions.push(at);
            mesh.normals.push([0.0, 1.0, 0.0]);
        }
        if step < steps {
            let [a, b, c, d] = [0, 1, 2, 3].map(|corner| 2 * step + corner);
            mesh.indices.extend([a, c, b, b, c, d]);
        }
    }
    let mut scene = Scene::empty("ramp");
    scene.meshes.push(mesh);
    scene.objects.push(Object {
        name: "ramp".into(),
        mesh: 0,
        transform: Affine3A::IDENTITY,
        casts: true,
        albedo: [0.5; 3],
        glow: [0.0; 3],
    });
    let unwrapping = Unwrapping::new(&scene, 256).unwrap();
    assert!(
        (2..16).contains(&unwrapping.charts),
        "{}",
        unwrapping.charts
    );
    // Half of it is one chart.
    let mesh = &mut scene.meshes[0];
    mesh.indices.truncate(6 * 50);
    assert_eq!(Unwrapping::new(&scene, 256).unwrap().charts, 1);
}

/// No triangle is stretched beyond what is said of the largest texel.
#[test]
fn texels_are_about_the_same_size_everywhere() {
    let scene = floor();
    let unwrapping = Unwrapping::new(&scene, 256).unwrap();
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
    for (object, placed) in unwrapping.objects.iter().zip(&scene.objects) {
        let [width, height] = [object.rectangle.width, object.rectangle.height];
        let texels = DVec2::new(width.into(), height.into());
        let triangles = object.positions.chunks_exact(3);
        for (corners, uvs) in triangles.zip(object.uvs.chunks_exact(3)) {
            let [a, b, c]: [DVec3; 3] = [0, 1, 2].map(|k| placed.world_point(corners[k]));
            let area = (b - a).cross(c - a).length();
            let [a, b, c] = [0, 1, 2].map(|k| DVec2::from_array(uvs[k].map(f64::from)) * texels);
            let texels = (b - a).perp_dot(c - a).abs();
            let side = (area / texels).sqrt();
            (smallest, largest) = (smallest.min(side), largest.max(side));
        }
    }
    assert!(largest <= 1.001 * unwrapping.texel, "{largest}");
    assert!(
        smallest > 0.8 * unwrapping.texel,
        "{smallest} of {}",
        unwrapping.texel
    );
}
