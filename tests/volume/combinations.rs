//! Every way to find silhouettes with every choice of what is drawn: one stencil buffer.

use shadows::glam::{Affine3A, Vec3};
use shadows::{Caps, HomogeneousLight, Method, ShadowVolumeRenderer, Silhouettes};

use crate::choices::depths;
use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// z-pass throughout is right in `stages`, whose casters are all beside the way to the light.
const CHOICES: [(Method, Caps); 4] = [
    (Method::ZFail, Caps::Full),
    (Method::ZFail, Caps::AsNeeded),
    (Method::Auto, Caps::AsNeeded),
    (Method::ZPass, Caps::AsNeeded),
];

fn stages() -> Vec<Stage> {
    let soup = shapes::sphere(8).turned(|triangle| triangle % 3 == 0);
    let several = |light| {
        Stage::new(
            light,
            vec![
                Body::caster(shapes::fins(4), at(-1.2, 0.7, 0.0)),
                Body::caster(soup.clone(), at(1.0, 1.2, -1.0)),
            ],
        )
    };
    let low = HomogeneousLight::point(Vec3::new(-3.5, 1.7, 0.4));
    vec![mixed(lamp()), mixed(sun()), several(low), several(sun())]
}

fn counts(gpu: &Gpu, stage: &Stage, savings: Savings) -> Vec<u8> {
    let stage = Stage {
        savings,
        ..stage.clone()
    };
    stage.counts(gpu)
}

fn differing(a: &[u8], b: &[u8]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn every_way_counts_the_same_with_every_method_and_cap() {
    let Some(gpu) = Gpu::for_test() else { return };
    for (place, stage) in stages().into_iter().enumerate() {
        for depth in depths(&gpu) {
            let stage = Stage {
                depth,
                ..stage.clone()
            };
            let mut first: Option<Vec<u8>> = None;
            for (method, caps) in CHOICES {
                let savings = |silhouettes| Savings {
                    method,
                    caps,
                    silhouettes,
                    ..Default::default()
                };
                let [compute, cpu, vertex] = WAYS.map(|way| counts(&gpu, &stage, savings(way)));
                let what = format!("stage {place}, {depth:?}, {method:?}, {caps:?}");
                assert!(
                    cpu.iter().filter(|&&count| count > 0).count() > 500,
                    "{what}"
                );
                assert!(cpu == compute, "{what}: {}", differing(&cpu, &compute));
                assert!(cpu == vertex, "{what}: {}", differing(&cpu, &vertex));
                let first = first.get_or_insert_with(|| cpu.clone());
                // Where a face touches the surface itself, the last place of depth decides.
                let differ = differing(first, &cpu);
                assert!(differ <= cpu.len() / 10_000, "{what}: {differ}");
            }
        }
    }
}

#[test]
fn another_light_counts_otherwise() {
    let Some(gpu) = Gpu::for_test() else { return };
    let [here, there] = [lamp(), sun()].map(|light| mixed(light).counts(&gpu));
    assert!(differing(&here, &there) > 500);
}

/// Casters extracted while the camera looks at the stage, away from it, and back.
fn extracted_when_turning(gpu: &Gpu, silhouettes: Silhouettes, keep: bool) -> [u32; 4] {
    let sphere = || shapes::sphere(8);
    let mut stage = Stage::new(
        HomogeneousLight::directional(Vec3::new(0.1, 1.0, 0.1)),
        vec![
            Body::caster(sphere(), at(0.0, 1.5, 0.0)),
            // Behind the camera, at first.
            Body::caster(shapes::cube(), at(1.0, 1.0, 25.0)),
            // Turned, so that the sun does not meet it like the other.
            Body::caster(
                sphere(),
                at(-1.5, 1.5, -1.0) * Affine3A::from_rotation_y(0.4),
            ),
        ],
    );
    stage.savings.silhouettes = silhouettes;
    let descriptor = shadows::ShadowVolumeDescriptor {
        keep_between_frames: keep,
        ..stage.descriptor()
    };
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    let casters = stage.casters(gpu);
    let there = Vec3::new(1.0, 0.0, 22.0);
    [stage.target, there, stage.target, there].map(|target| {
        stage.target = target;
        let picture = stage.draw_with(gpu, &mut renderer, &casters);
        let found = stage.truth().errors(&picture);
        assert_eq!(
            found.wrong, 0,
            "{silhouettes:?}, {keep}, {target}: {found:?}"
        );
        let statistics = renderer.statistics();
        assert!(
            statistics.skipped_out_of_view > 0,
            "{target}: {statistics:?}"
        );
        statistics.casters_extracted
    })
}

#[test]
fn what_leaves_the_view_is_kept_until_it_comes_back() {
    let Some(gpu) = Gpu::for_test() else { return };
    for way in [Silhouettes::Cpu, Silhouettes::Compute] {
        assert_eq!(extracted_when_turning(&gpu, way, true), [2, 1, 0, 0]);
        assert_eq!(extracted_when_turning(&gpu, way, false), [2, 1, 2, 1]);
    }
}
