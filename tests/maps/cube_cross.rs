//! The debug view: every texel of the map where the cross says it is.

use crate::common::noop;
use crate::common::shapes::{Random, cuboid};
use crate::cubes::{faces, fresh};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::CubeShadowMapError;
use shadows::{
    Caster, CubeCross, CubeCrossDescriptor, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding,
    PointLight, glam, wgpu,
};

const SIZE: u32 = 32;
const NEAR: f32 = 0.5;
const LIGHT: PointLight = PointLight {
    position: Vec3::new(0.2, 0.1, -0.3),
    range: 9.0,
    near: Some(NEAR),
};

fn cross(gpu: &Gpu, map: &CubeShadowMap, encoding: DepthEncoding) -> Vec<[u8; 4]> {
    let target = gpu.target([4 * SIZE, 3 * SIZE], wgpu::TextureFormat::Rgba8Unorm, 1);
    gpu.checked(|| {
        let cross = CubeCross::new(
            &gpu.device,
            &CubeCrossDescriptor {
                encoding,
                ..Default::default()
            },
        )
        .unwrap();
        let group = cross.bind_group(&gpu.device, map).unwrap();
        gpu.run(|encoder| {
            let view = target.create_view(&Default::default());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::RED),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            cross.render(&mut pass, &group);
        });
    });
    let bytes = gpu.read_texture(&target, 0, wgpu::TextureAspect::All);
    bytemuck::pod_collect_to_vec(&bytes)
}

/// The cross as the six faces' bytes give it, with the faces in these cells.
fn expected(
    gpu: &Gpu,
    map: &CubeShadowMap,
    encoding: DepthEncoding,
    cells: [(u32, u32); 6],
) -> Vec<[u8; 4]> {
    let mut picture = vec![[255, 0, 0, 255]; (12 * SIZE * SIZE) as usize];
    for (face, (column, row)) in faces(gpu, map).iter().zip(cells) {
        let texels: Vec<f32> = bytemuck::pod_collect_to_vec(face);
        for (i, depth) in (0..).zip(texels) {
            let (x, y) = (column * SIZE + i % SIZE, row * SIZE + i / SIZE);
            let along = match encoding {
                DepthEncoding::MajorAxis => NEAR / (depth * LIGHT.range),
                _ => depth,
            };
            let grey = (255.0 * (1.0 - along.min(1.0))).round() as u8;
            picture[(y * 4 * SIZE + x) as usize] = match depth == encoding.clear_depth() {
                true => [0, 0, 64, 255],
                false => [grey, grey, grey, 255],
            };
        }
    }
    picture
}

#[test]
fn the_cross_shows_every_texel_in_its_place() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = cuboid(Vec3::splat(0.8)).mesh(&gpu.device);
    let mut random = Random::new(17);
    let casters: Vec<Caster> = (0..30)
        .map(|_| random.vec3().normalize() * (3.0 + 2.0 * random.next()))
        .map(|at| Caster::new(mesh.clone(), Affine3A::from_translation(at)))
        .collect();
    let cells = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)];
    let swapped = [(0, 1), (2, 1), (1, 0), (1, 2), (1, 1), (3, 1)];
    for encoding in [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance] {
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            encoding,
            ..Default::default()
        };
        let map = fresh(&gpu, &descriptor, LIGHT, &casters);
        let seen = cross(&gpu, &map, encoding);
        let differ = |cells| {
            let truth = expected(&gpu, &map, encoding, cells);
            let far =
                |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
            seen.iter().zip(&truth).filter(|&pair| far(pair)).count()
        };
        assert_eq!(differ(cells), 0, "{encoding:?}");
        assert!(differ(swapped) > 100, "the broken twin: +X and -X swapped");
    }
}

#[test]
fn a_cross_of_another_encoding_is_refused() {
    let (device, _) = noop();
    let both = [DepthEncoding::MajorAxis, DepthEncoding::LinearDistance];
    for map_encoding in both {
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            encoding: map_encoding,
            ..Default::default()
        };
        let map = CubeShadowMap::new(&device, &descriptor).unwrap();
        for encoding in both {
            let descriptor = CubeCrossDescriptor {
                encoding,
                ..Default::default()
            };
            let cross = CubeCross::new(&device, &descriptor).unwrap();
            let expected = match encoding == map_encoding {
                true => Ok(()),
                false => Err(CubeShadowMapError::Encoding {
                    map: map_encoding,
                    cross: encoding,
                }),
            };
            assert_eq!(cross.bind_group(&device, &map).map(drop), expected);
        }
    }
}
