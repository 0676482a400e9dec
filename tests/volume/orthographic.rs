//! Orthographic views, of which infinitely far corners are at w = 0: point lights around, in and close to
//! casters, whose far caps pass around the whole picture.

use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{DepthConvention, HomogeneousLight, Method};

use crate::choices::TEXTBOOK;
use crate::random;
use crate::shapes;
use crate::stage::{Body, Lens, Savings, Stage, WAYS};
use crate::truth::Errors;
use host::gpu::Gpu;
use host::random::Random;

/// The stage in parallel projection, from where its camera stands and a little above.
fn parallel(stage: Stage) -> Stage {
    let back = (stage.eye - stage.target + Vec3::Y).normalize();
    Stage {
        lens: Lens::Orthographic,
        near: 0.5,
        eye: stage.target + 40.0 * back,
        ..stage
    }
}

/// A random scene with a point light, and whether that is within a caster's box.
fn scene(seed: u64, gpu: &Gpu) -> Option<(Stage, bool)> {
    let stage = random::scene(seed, gpu);
    if stage.light.is_directional() || stage.depth == DepthConvention::InfiniteReverse {
        return None;
    }
    let light = stage.light.xyzw().truncate();
    let around = |body: &Body| {
        let box_ = Stage::bounds(std::slice::from_ref(body));
        light.cmpge(box_.min).all() && light.cmple(box_.max).all()
    };
    let inside = stage.bodies[1..].iter().any(around);
    Some((parallel(stage), inside))
}

fn assert_exact(gpu: &Gpu, stage: &Stage, savings: Savings, what: &str) -> Errors {
    let picture = Stage {
        savings,
        ..stage.clone()
    }
    .draw(gpu);
    let found = stage.truth().errors(&picture);
    assert_eq!(found.wrong, 0, "{what}: {found:?}, {savings:?}");
    found
}

#[test]
fn random_scenes_are_exact() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (mut scenes, mut around, mut lit, mut shadowed) = (0, 0, 0, 0);
    for seed in 0..200 {
        let Some((stage, inside)) = scene(seed, &gpu) else {
            continue;
        };
        scenes += 1;
        around += usize::from(inside);
        let way = Savings {
            silhouettes: WAYS[seed as usize % 3],
            ..Default::default()
        };
        assert_exact(&gpu, &stage, way, &format!("seed {seed}"));
        let all = Stage {
            range: None,
            ..stage
        };
        let found = assert_exact(&gpu, &all, TEXTBOOK, &format!("seed {seed}, textbook"));
        lit += found.lit;
        shadowed += found.shadowed;
    }
    assert!(scenes > 60 && around > 15, "{scenes}, {around}");
    assert!(lit > 100_000 && shadowed > 30_000, "{lit}, {shadowed}");
}

#[test]
fn caps_reach_the_borders_of_a_large_picture() {
    let Some(gpu) = Gpu::for_test() else { return };
    for seed in [14, 38, 52] {
        let (stage, inside) = scene(seed, &gpu).unwrap();
        assert!(inside);
        let stage = Stage {
            range: None,
            side: 1024,
            samples: 1,
            ..stage
        };
        let found = assert_exact(&gpu, &stage, TEXTBOOK, &format!("seed {seed}"));
        assert!(found.interior > 300_000, "{found:?}");
    }
}

#[test]
fn lights_may_be_close_to_casters() {
    let Some(gpu) = Gpu::for_test() else { return };
    let room = shapes::cube().cut(|corners| corners.iter().any(|c| c.y > -0.5));
    // Over a surface, from outside the caster's box and from within, and how close.
    let cases: [(_, f32, f32, &[f32]); 3] = [
        (shapes::square(1.0), 0.0, 1.0, &[0.3, 1e-2, 1e-4, 1e-6]),
        (shapes::cube(), 1.0, 1.0, &[0.3, 1e-2, 1e-4, 1e-6]),
        (room, 1.0, -1.0, &[0.3, 1e-2, 1e-3]),
    ];
    for (shape, surface, side, heights) in cases {
        for (height, seed) in heights
            .iter()
            .flat_map(|h| (0..4).map(move |seed| (h, seed)))
        {
            let random = &mut Random(seed + 77);
            let turn = Quat::from_scaled_axis(random.point(1.0));
            let place = Affine3A::from_rotation_translation(turn, Vec3::new(0.0, 2.0, 0.0));
            let (x, z) = (random.within(-0.5, 0.5), random.within(-0.5, 0.5));
            let light = place.transform_point3(Vec3::new(x, surface + side * height, z));
            let bodies = vec![Body::caster(shape.clone(), place)];
            let stage = parallel(Stage {
                depth: match seed % 2 {
                    0 => DepthConvention::Standard,
                    _ => DepthConvention::FiniteReverse,
                },
                eye: random.point(4.0) + Vec3::Y * 4.0,
                side: 128,
                ..Stage::new(HomogeneousLight::point(light), bodies)
            });
            let z_fail = Savings {
                method: Method::ZFail,
                ..Default::default()
            };
            let found = assert_exact(&gpu, &stage, z_fail, &format!("{height}, seed {seed}"));
            assert!(found.interior > 5_000, "{found:?}");
        }
    }
}
