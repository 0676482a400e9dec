//! How far the depth planes that a driver draws are from the exact ones: a floor far larger than its
//! distance from the light, seen by the faces of a cube map.

use crate::common::shapes::{Shape, square};
use glam::{Affine3A, DVec3, Quat, Vec3};
use host::gpu::Gpu;
use shadows::{CubeFace, CubeShadowMapDescriptor, DepthEncoding, PointLight, glam};

/// The default bias toward the light, in texels: what rounding of depths and snapping of vertices must
/// stay below. Vertices that are snapped to 1/256 of a texel, as on every GPU, make at most `sqrt(2) / 512` =
/// 0.0028 of it; to 1/16, which Vulkan allows, `sqrt(2) / 32` = 0.044.
const BOUND: f64 = 0.05;

/// Of the texels that see the floor: how many, how many of them hold nothing, and the largest error of
/// a depth, in texels: as a share, over how much the plane's distance changes within a texel.
#[derive(Default)]
struct Error {
    covered: usize,
    missing: usize,
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

#[derive(Debug)]
struct Floor {
    /// Texels along a face.
    size: u32,
    near: f32,
    /// Half of its width; it lies 1 below the light.
    half: f32,
    tilt: f32,
    /// Squares of two triangles along its width.
    cells: u32,
}

/// A square in the xz plane, of so many squares along its width.
fn grid(half: f32, cells: u32) -> Shape {
    let at = |place: u32| half * (2.0 * place as f32 / cells as f32 - 1.0);
    let corners = (0..=cells).flat_map(|i| (0..=cells).map(move |j| [at(i), 0.0, at(j)]));
    let row = cells + 1;
    let squares = (0..cells).flat_map(|i| (0..cells).map(move |j| i * row + j));
    let triangles = squares.flat_map(|a| [a, a + 1, a + row + 1, a, a + row + 1, a + row]);
    Shape {
        positions: corners.collect(),
        indices: triangles.collect(),
    }
}

/// `farther` is how much farther from the light than it is drawn the floor is taken to be, in texels.
fn measure(gpu: &Gpu, floor: &Floor, farther: f64) -> Error {
    let descriptor = CubeShadowMapDescriptor {
        size: floor.size,
        ..Default::default()
    };
    let turn = Quat::from_rotation_z(floor.tilt) * Quat::from_rotation_y(0.3 * floor.tilt);
    let caster = grid(floor.half, floor.cells).caster(&gpu.device, Affine3A::from_quat(turn));
    let up = turn * Vec3::Y;
    let light = PointLight {
        near: Some(floor.near),
        ..PointLight::new(up, 200.0)
    };
    let map = crate::cubes::fresh(gpu, &descriptor, light, &[caster]);
    let mut error = Error::default();
    for (face, bytes) in CubeFace::ALL
        .into_iter()
        .zip(crate::cubes::faces(gpu, &map))
    {
        let stored: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
        for (i, &depth) in stored.iter().enumerate() {
            let at = |place: u32| (f64::from(place) + 0.5) * 2.0 / f64::from(floor.size) - 1.0;
            let (u, v) = (at(i as u32 % floor.size), at(i as u32 / floor.size));
            let direction = direction(face, u, v);
            let cosine = -direction.dot(up.as_dvec3()) / direction.length();
            // Along the major axis.
            let distance = 1.0 / (cosine * direction.length());
            // Not at the floor's rim, nor before the near plane, onto which it is pulled there.
            let hit = turn.as_dquat().inverse() * (direction * distance);
            let inside = hit.x.abs().max(hit.z.abs()) < 0.8 * f64::from(floor.half);
            if !(cosine > 0.0 && inside && distance > f64::from(floor.near)) {
                continue;
            }
            error.covered += 1;
            if depth == 0.0 {
                error.missing += 1;
                continue;
            }
            let tangent = (1.0 - cosine * cosine).sqrt() / cosine;
            let texel = 2.0 / f64::from(floor.size) * tangent.max(1.0);
            let expected = f64::from(floor.near) / (distance * (1.0 + farther * texel));
            error.texels = error
                .texels
                .max((f64::from(depth) / expected - 1.0).abs() / texel);
        }
    }
    error
}

#[test]
fn planes_far_larger_than_the_near_planes_field_are_where_they_should_be() {
    let Some(gpu) = Gpu::for_test() else { return };
    for size in [64, 512] {
        for (half, tilt) in [(150.0, 0.0), (150.0, 0.4), (5.0, 0.4)] {
            for near in [0.5, 2e-3, 1.2e-5] {
                check(
                    &gpu,
                    &Floor {
                        size,
                        near,
                        half,
                        tilt,
                        cells: 1,
                    },
                );
            }
        }
    }
}

/// The same of triangles that are no larger than 2.4 times their distance: drivers that know only 1/16 of a
/// texel, and continue a triangle's depth from its corners as they were snapped, have those right.
#[test]
fn planes_of_small_triangles_are_where_they_should_be() {
    let Some(gpu) = Gpu::for_test() else { return };
    for (size, tilt) in [(64, 0.0), (512, 0.4)] {
        check(
            &gpu,
            &Floor {
                size,
                near: 2e-3,
                half: 150.0,
                tilt,
                cells: 127,
            },
        );
    }
}

fn check(gpu: &Gpu, floor: &Floor) {
    let error = measure(gpu, floor, 0.0);
    println!("{floor:?}: {:.4} texels off", error.texels);
    assert!(error.covered > 5000);
    assert_eq!(error.missing, 0, "{floor:?}");
    assert!(error.texels < BOUND, "{floor:?}: {}", error.texels);
    // The broken twin: taken for a tenth of a texel farther than it is.
    let twin = measure(gpu, floor, 0.1);
    assert!(twin.texels > BOUND, "{floor:?}: {}", twin.texels);
}

/// How far the distances of a floor straight below the light are from those along the texels' own rays, as a
/// share. However vertices are snapped, such a floor lies where it should.
fn off_the_rays(gpu: &Gpu, size: u32, farther: f64) -> f64 {
    let range = 200.0;
    let descriptor = CubeShadowMapDescriptor {
        size,
        encoding: DepthEncoding::LinearDistance,
        ..Default::default()
    };
    let turn = Quat::from_rotation_y(0.2);
    let caster = square(5.0).caster(&gpu.device, Affine3A::from_quat(turn));
    let light = PointLight::new(Vec3::Y, range);
    let map = crate::cubes::fresh(gpu, &descriptor, light, &[caster]);
    let below = &crate::cubes::faces(gpu, &map)[CubeFace::NegativeY.layer() as usize];
    let stored: Vec<f32> = bytemuck::pod_collect_to_vec(below);
    let at = |place: u32| (f64::from(place) + 0.5) * 2.0 / f64::from(size) - 1.0;
    (0..)
        .zip(stored)
        .map(|(i, distance)| {
            let ray = DVec3::new(at(i % size), at(i / size), 1.0);
            let expected = ray.length() * (1.0 + farther) / f64::from(range);
            (f64::from(distance) / expected - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn distances_are_those_along_the_texels_own_rays() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Four roundings. An interpolated position was off by 3e-5 on SwiftShader.
    let bound = 2.5e-7;
    for size in [64, 500] {
        let off = off_the_rays(&gpu, size, 0.0);
        assert!(off < bound, "{size} texels: {off:e}");
        // The broken twin.
        let twin = off_the_rays(&gpu, size, 1e-6);
        assert!(twin > bound, "{size} texels: {twin:e}");
    }
}
