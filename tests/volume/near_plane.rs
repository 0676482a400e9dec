//! A near plane that cuts a caster. The host's surfaces are clipped there. So are volumes, by clip distances
//! where depth has a far plane. Where there are none they pass the plane, and what both have in common rounds
//! otherwise: not enough to be seen on a software rasteriser, but on GPUs (docs/gpu.md).

use shadows::glam::Vec3;
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::{DepthConvention, Method, View, wgpu};

use crate::choices::depths;
use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Savings, Stage, WAYS};
use crate::truth::Errors;
use host::gpu::Gpu;
use host::random::Random;

/// A camera somewhere in front of the scene, its near plane in the middle of it or a little before.
fn stage(random: &mut Random, turn: usize, depth: DepthConvention) -> Stage {
    let eye = Vec3::new(1.0, 5.0, 9.0) + random.point(2.0);
    let target = Vec3::new(0.0, 0.5, 0.0);
    let near = eye.distance(target) * random.within(0.75, 1.0);
    let far = near * [1e3, 1e5][turn / 2 % 2];
    let projection = match depth {
        DepthConvention::InfiniteReverse => proj::perspective_infinite_reverse(0.9, 1.0, near),
        DepthConvention::FiniteReverse => proj::perspective(0.9, 1.0, far, near),
        DepthConvention::Standard => proj::perspective(0.9, 1.0, near, far),
    };
    let camera = view::look_at_mat4(eye, target, Vec3::Y);
    let mut stage = Stage {
        depth,
        placed_view: View::new(projection * camera, depth).ok(),
        ..mixed([lamp(), sun()][turn % 2])
    };
    let sphere = Body::caster(shapes::sphere(20), at(-1.5, 1.5, 1.5));
    stage.bodies.push(sphere);
    stage
}

/// Of `count` such cameras, the same for every convention.
fn stages(count: usize, depth: DepthConvention) -> impl Iterator<Item = Stage> {
    let mut random = Random(5);
    (0..count).map(move |turn| stage(&mut random, turn, depth))
}

fn errors(gpu: &Gpu, stage: &Stage, method: Method, what: &str) -> Errors {
    let savings = Savings {
        method,
        ..stage.savings
    };
    let stage = Stage {
        savings,
        ..stage.clone()
    };
    let found = stage.truth().errors(&stage.draw(gpu));
    assert!(
        found.interior > 10_000 && found.shadowed > 300,
        "{what}: {found:?}"
    );
    found
}

/// With clip distances, and without where that is right.
fn gpus() -> Vec<Gpu> {
    let Some(gpu) = Gpu::for_test() else {
        return Vec::new();
    };
    let mut gpus = vec![gpu];
    if gpus[0].info.device_type == wgpu::DeviceType::Cpu {
        gpus.extend(Gpu::for_test_without(wgpu::Features::CLIP_DISTANCES));
    }
    gpus
}

#[test]
fn the_near_plane_may_cut_a_caster_in_every_convention_and_format() {
    let formats = [
        wgpu::TextureFormat::Depth24PlusStencil8,
        wgpu::TextureFormat::Depth32FloatStencil8,
    ];
    for gpu in gpus() {
        for depth in depths(&gpu) {
            for format in formats {
                assert_right(&gpu, format, depth);
            }
        }
    }
}

fn assert_right(gpu: &Gpu, format: wgpu::TextureFormat, depth: DepthConvention) {
    for (turn, stage) in stages(4, depth).enumerate() {
        let stage = Stage { format, ..stage };
        for method in [Method::Auto, Method::ZFail] {
            let what = format!("{turn}, {format:?}, {depth:?}, {method:?}");
            let found = errors(gpu, &stage, method, &what);
            assert_eq!(found.wrong, 0, "{what}: {found:?}");
        }
    }
}

#[test]
fn so_it_may_whichever_way_silhouettes_are_found() {
    let Some(gpu) = Gpu::for_test() else { return };
    for silhouettes in WAYS {
        for mut stage in stages(2, DepthConvention::Standard) {
            if !depths(&gpu).contains(&stage.depth) {
                return;
            }
            stage.savings.silhouettes = silhouettes;
            let what = format!("{silhouettes:?}");
            let found = errors(&gpu, &stage, Method::ZFail, &what);
            assert_eq!(found.wrong, 0, "{what}: {found:?}");
        }
    }
}

/// The broken twin: near planes in the shadow of what they cut, and z-pass all the same.
#[test]
fn forced_z_pass_is_found_out_there() {
    let Some(gpu) = Gpu::for_test() else { return };
    let wrong: usize = stages(4, DepthConvention::InfiniteReverse)
        .map(|stage| errors(&gpu, &stage, Method::ZPass, "forced").wrong)
        .sum();
    assert!(wrong > 1000, "{wrong}");
}

/// Caps that are clipped where the host's surfaces are have their very depths, and need no bias.
#[test]
fn caps_that_the_near_plane_cuts_need_no_bias() {
    for gpu in gpus() {
        for depth in depths(&gpu) {
            for stage in stages(4, depth) {
                let stage = Stage {
                    cap_bias_ulps: 0,
                    ..stage
                };
                let found = errors(&gpu, &stage, Method::ZFail, "no bias");
                assert_eq!(found.wrong, 0, "{depth:?}: {found:?}");
            }
        }
    }
}
