//! Receivers of one kind of light: those of any, at less cost.

use glam::Vec3;
use shadows::{AnyMap, FlatLights, Kernel, MapKind, PcfDescriptor, ShadowFrame, ShadowMap, glam};

use super::{Bias, Gpu, drawn, field, of_size, spot, sun};
use crate::common::shapes::Random;
use crate::receivers::ask;

/// Random points of the ground, with normals that lean.
fn points() -> Vec<(Vec3, Vec3)> {
    let mut random = Random::new(31);
    (0..1500)
        .map(|_| {
            let at = Vec3::new(random.next(), 0.0, random.next()) * 5.0;
            let normal = (Vec3::Y + 0.4 * random.vec3()) * (1.5 + random.next());
            (at, normal)
        })
        .collect()
}

fn seen(gpu: &Gpu, map: &ShadowMap, kernel: Kernel, lights: FlatLights) -> Vec<f32> {
    let descriptor = PcfDescriptor {
        kernel,
        map: MapKind::Flat(lights),
        ..Default::default()
    };
    ask(gpu, AnyMap::Flat(map), &descriptor, 0, &points())
}

#[test]
fn receivers_of_one_kind_see_what_those_of_any_do_and_another_kind_is_dark() {
    let Some(gpu) = Gpu::for_test() else { return };
    let field = field(&gpu);
    let down = spot(Vec3::Y * 9.0, Vec3::new(0.1, -1.0, 0.0), 0.7, 1.0);
    for (light, own, other) in [
        (down, FlatLights::Spot, FlatLights::Directional),
        (
            sun(Vec3::new(0.4, 1.0, 0.2)),
            FlatLights::Directional,
            FlatLights::Spot,
        ),
    ] {
        let frame = ShadowFrame::new(light, &field.casters);
        let map = drawn(&gpu, &of_size(512, Bias::default()), &frame);
        for kernel in Kernel::ALL {
            let any = seen(&gpu, &map, kernel, FlatLights::Any);
            let shadowed = any.iter().filter(|&&lit| lit < 0.5).count();
            assert!((50..1450).contains(&shadowed), "{kernel:?}: {shadowed}");
            // Compilers round the two differently, which moves what lies on an edge.
            let one = seen(&gpu, &map, kernel, own);
            let differ = any.iter().zip(&one).filter(|(a, b)| (*a - *b).abs() > 0.01);
            assert!(differ.count() < 4, "{kernel:?} {own:?}");
            let dark = seen(&gpu, &map, kernel, other);
            assert!(dark.iter().all(|&lit| lit == 0.0), "{kernel:?} {other:?}");
        }
    }
}

#[test]
fn without_casters_receivers_of_every_kind_are_lit_and_before_the_first_frame_dark() {
    let Some(gpu) = Gpu::for_test() else { return };
    let blank = ShadowMap::new(&gpu.device, &of_size(64, Bias::default())).unwrap();
    let sun = ShadowFrame::new(sun(Vec3::Y), &[]);
    let spot = ShadowFrame::new(spot(Vec3::Y * 9.0, Vec3::NEG_Y, 1.2, 1.0), &[]);
    let [sun, spot] = [sun, spot].map(|frame| drawn(&gpu, &of_size(64, Bias::default()), &frame));
    for (lights, empty) in [
        (FlatLights::Any, &sun),
        (FlatLights::Any, &spot),
        (FlatLights::Spot, &spot),
        (FlatLights::Directional, &sun),
    ] {
        for kernel in Kernel::ALL {
            let lit = seen(&gpu, empty, kernel, lights);
            assert!(lit.iter().all(|&lit| lit == 1.0), "{kernel:?} {lights:?}");
            let dark = seen(&gpu, &blank, kernel, lights);
            assert!(dark.iter().all(|&lit| lit == 0.0), "{kernel:?} {lights:?}");
        }
    }
}
