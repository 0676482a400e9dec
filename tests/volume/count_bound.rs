//! How many volumes a point can be in, and whether a byte could wrap.

use shadows::glam::Vec3;
use shadows::{HomogeneousLight, ShadowVolumeRenderer};

use crate::counts::{boxes, exact, exact_counts, gpu, sheets, with};
use crate::pictures::{at, lamp};
use crate::random;
use crate::shapes;
use crate::stage::{Body, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// A renderer of the stage that has prepared its frame.
fn prepared(gpu: &Gpu, stage: &Stage) -> ShadowVolumeRenderer {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    renderer
}

#[test]
fn a_count_that_could_wrap_is_announced() {
    let Some(gpu) = gpu() else { return };
    for (stage, count) in [
        (sheets(1), 1),
        (sheets(255), 255),
        (sheets(256), 256),
        (sheets(257), 257),
        (sheets(512), 512),
        (boxes(127), 254),
        (boxes(128), 256),
    ] {
        let mut stencil = prepared(&gpu, &stage);
        assert_eq!(stencil.count_bound(0, 0), count);
        assert_eq!(stencil.may_wrap(0, 0), count > 255);
        assert!(!prepared(&gpu, &with(&stage, exact())).may_wrap(0, 0));
    }
}

#[test]
fn no_pixel_counts_more_than_the_bound() {
    let Some(gpu) = gpu() else { return };
    let (mut overlaps, mut deeper_than_casters) = (0, 0);
    for seed in 0..60 {
        let stage = Stage {
            samples: 1,
            savings: exact(),
            ..random::scene(seed, &gpu)
        };
        let counts = exact_counts(&gpu, &stage);
        let deepest = counts
            .iter()
            .fold(0.0, |most: f32, count| most.max(count.abs()));
        let savings = Savings {
            silhouettes: WAYS[seed as usize % 3],
            ..Default::default()
        };
        let bound = prepared(&gpu, &with(&stage, savings)).count_bound(0, 0);
        assert!(deepest <= bound as f32, "seed {seed}: {deepest}, {bound}");
        overlaps += i32::from(deepest > 1.0);
        // The broken twin: one for each caster.
        let casters = stage.bodies.iter().filter(|body| body.casts).count();
        deeper_than_casters += i32::from(deepest > casters as f32);
    }
    assert!(overlaps > 20, "{overlaps}");
    assert!(deeper_than_casters > 5, "{deeper_than_casters}");
}

#[test]
fn the_bound_is_near_where_casters_are_simple() {
    let Some(gpu) = gpu() else { return };
    let sphere = |x: f32| Body::caster(shapes::sphere(24), at(x, 1.2, 0.0));
    let mut apart = prepared(&gpu, &Stage::new(lamp(), vec![sphere(-2.0), sphere(2.0)]));
    assert_eq!(apart.count_bound(0, 0), 1);
    let mut together = prepared(&gpu, &Stage::new(lamp(), vec![sphere(0.0), sphere(0.2)]));
    assert_eq!(together.count_bound(0, 0), 2);
    // Inside, every way out leads through the wall: no silhouette says so.
    let inside = HomogeneousLight::point(Vec3::new(0.1, 1.3, 0.2));
    let mut around = prepared(&gpu, &Stage::new(inside, vec![sphere(0.0)]));
    assert_eq!(around.count_bound(0, 0), 1);
}

#[test]
fn the_bound_follows_what_moves() {
    let Some(gpu) = gpu() else { return };
    let stage = sheets(2);
    let mut renderer = prepared(&gpu, &stage);
    assert_eq!(renderer.count_bound(0, 0), 2);
    let mut casters = stage.casters(&gpu);
    stage.prepare(&gpu, &mut renderer, &casters);
    assert_eq!(renderer.count_bound(0, 0), 2);
    casters[1].world_from_object = at(0.0, 1.0, 5.0);
    stage.prepare(&gpu, &mut renderer, &casters);
    assert_eq!(renderer.count_bound(0, 0), 1);
    stage.prepare(&gpu, &mut renderer, &[]);
    assert_eq!(renderer.count_bound(0, 0), 0);
}
