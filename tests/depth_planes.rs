//! How far the depth planes that a driver draws are from the exact ones: a floor far larger than its
//! distance from the light, seen by the faces of a cube map.

mod common;
#[path = "common/cubes.rs"]
mod cubes;
#[path = "../examples/host/mod.rs"]
mod host;

use common::shapes::square;
use glam::{Affine3A, DVec3, Quat, Vec3};
use host::gpu::Gpu;
use shadows::{CubeFace, CubeShadowMapDescriptor, PointLight, glam};

/// Of the texels that see the floor: how many, the largest error of depth as a share, and in texels
/// (of the width of a texel there, along the ray, as the bias has it).
struct Error {
    covered: usize,
    missing: usize,
    extra: usize,
    share: f64,
    texels: f64,
}

/// Length 1 along the face's axis; `u` right, `v` down.
fn direction(face: CubeFace, u: f64, v: f64) -> DVec3 {
    match face {
        CubeFace::PositiveX => DVec3::new(1.0, -v, -u),
        CubeFace::NegativeX => DVec3::new(-1.0, -v, u),
        CubeFace::PositiveY => DVec3::new(u, 1.0, v),
        CubeFace::NegativeY => DVec3::new(u, -1.0, -v),
        CubeFace::PositiveZ => DVec3::new(u, -v, 1.0),
        CubeFace::NegativeZ => DVec3::new(-u, -v, -1.0),
    }
}

fn measure(gpu: &Gpu, near: f32, side: f32, size: u32, tilt: f32) -> Error {
    let descriptor = CubeShadowMapDescriptor {
        size,
        ..Default::default()
    };
    let turn = Quat::from_rotation_z(tilt) * Quat::from_rotation_y(0.3 * tilt);
    let transform = Affine3A::from_quat(turn);
    let caster = square(side).caster(&gpu.device, transform);
    let up = turn * Vec3::Y;
    let light = PointLight {
        near: Some(near),
        ..PointLight::new(up, 200.0)
    };
    let map = cubes::fresh(gpu, &descriptor, &[light], &[caster]);
    let mut error = Error {
        covered: 0,
        missing: 0,
        extra: 0,
        share: 0.0,
        texels: 0.0,
    };
    let (n, inverse) = (up.as_dvec3(), turn.as_dquat().inverse());
    for (face, bytes) in CubeFace::ALL.into_iter().zip(cubes::faces(gpu, &map, 0)) {
        let stored: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
        for (i, &depth) in stored.iter().enumerate() {
            let at = |place: u32| (f64::from(place) + 0.5) * 2.0 / f64::from(size) - 1.0;
            let (u, v) = (at(i as u32 % size), at(i as u32 / size));
            let direction = direction(face, u, v);
            // Along the major axis, to the plane 1 below the light.
            let down = -direction.dot(n);
            let distance = 1.0 / down;
            let hit = inverse * (direction * distance);
            let inside = hit.x.abs().max(hit.z.abs()) / f64::from(side);
            let rim = (inside - 1.0).abs() * f64::from(side)
                < 4.0 * distance * distance / f64::from(size);
            if down <= 1e-9 || rim {
                continue;
            }
            if inside > 1.0 || distance > 150.0 {
                error.extra += usize::from(depth > 0.0 && inside > 1.0);
                continue;
            }
            error.covered += 1;
            if depth == 0.0 {
                error.missing += 1;
                continue;
            }
            let share = (f64::from(depth) * distance / f64::from(near) - 1.0).abs();
            error.share = error.share.max(share);
            // Moving one texel across changes the distance by `distance * 2 / size * tan`.
            let cosine = down / direction.length();
            let tangent = (1.0 - cosine * cosine).sqrt() / cosine;
            let texel = 2.0 / f64::from(size) * tangent.max(1.0);
            error.texels = error.texels.max(share / texel);
        }
    }
    error
}

#[test]
fn depth_planes_are_where_they_should_be() {
    let Some(gpu) = Gpu::for_test() else { return };
    println!("{} {}", gpu.info.name, gpu.info.driver_info);
    for size in [64, 1024] {
        for tilt in [0.0, 0.4] {
            for side in [150.0, 5.0] {
                for near in [1.0, 0.05, 0.002, 2e-4, 1.2e-5] {
                    let e = measure(&gpu, near, side, size, tilt);
                    println!(
                        "size {size} tilt {tilt} side {side} near {near}: covered {} missing {} extra {} worst share {:.2e}, texels {:.4}",
                        e.covered, e.missing, e.extra, e.share, e.texels
                    );
                }
            }
        }
    }
}
