//! One renderer for several views and lights of one submission.

use shadows::glam::{Quat, Vec3};
use shadows::{HomogeneousLight, Silhouettes, View, wgpu};

use crate::kept::{Theatre, count, frame};
use crate::pictures::{lamp, mixed, sun};
use crate::stage::WAYS;
use host::gpu::Gpu;

/// A view, a light, and the numbers of casters.
type Scene = (View, HomogeneousLight, std::ops::Range<usize>);

fn eye(turn: f32) -> View {
    let mut stage = mixed(lamp());
    stage.eye = Quat::from_rotation_y(turn) * Vec3::new(1.0, 5.0, 9.0);
    stage.view()
}

/// Records both into one encoder, in the order of a host that heeds the manual, or else both uploads
/// before both passes.
fn together(
    theatre: &Theatre,
    way: Silhouettes,
    scenes: &[Scene; 2],
    in_order: bool,
) -> [Vec<u8>; 2] {
    let mut renderer = theatre.renderer(way);
    let targets = [theatre.target(), theatre.target()];
    let draw = |encoder: &mut wgpu::CommandEncoder| {
        for ((view, light, numbers), target) in scenes.iter().zip(&targets) {
            let casters = theatre.casters(numbers.clone());
            theatre.prepare(&mut renderer, &frame(view, *light, &casters));
            renderer.encode(encoder);
            if in_order {
                count(&renderer, encoder, target);
            }
        }
        if !in_order {
            targets
                .iter()
                .for_each(|target| count(&renderer, encoder, target));
        }
    };
    theatre.gpu.run(draw);
    [0, 1].map(|i| theatre.counts(&targets[i]))
}

fn alone(theatre: &Theatre, way: Silhouettes, scenes: &[Scene; 2]) -> [Vec<u8>; 2] {
    [0, 1].map(|i| {
        let (view, light, numbers) = &scenes[i];
        let casters = theatre.casters(numbers.clone());
        theatre.fresh(way, &frame(view, *light, &casters))
    })
}

#[test]
fn two_views_of_one_submission_are_each_as_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let other = HomogeneousLight::point(Vec3::new(2.0, 5.0, -1.0));
    let cases: [(&str, [Scene; 2]); 4] = [
        (
            "two cameras",
            [(eye(0.0), lamp(), 0..20), (eye(0.4), lamp(), 0..20)],
        ),
        (
            "two lights",
            [(eye(0.0), lamp(), 0..20), (eye(0.0), other, 0..20)],
        ),
        (
            "lamp and sun",
            [(eye(0.0), lamp(), 0..20), (eye(0.2), sun(), 5..30)],
        ),
        (
            "buffers that grow",
            [(eye(0.0), lamp(), 0..5), (eye(0.1), lamp(), 0..300)],
        ),
    ];
    for (what, scenes) in &cases {
        for way in WAYS {
            let [first, second] = alone(&theatre, way, scenes);
            assert!(first != second, "{what}, {way:?}");
            let [a, b] = together(&theatre, way, scenes, true);
            assert!(a == first, "{what}, {way:?}: the first");
            assert!(b == second, "{what}, {way:?}: the second");
            // Out of order, the second is what both get.
            let [a, b] = together(&theatre, way, scenes, false);
            assert!(a == second && b == second, "{what}, {way:?}");
        }
    }
}
