//! Blob shadows.

use std::time::Instant;

use host::gpu::Gpu;
use host::renderer::{Renderer, view};
use host::scene::{Scene, floor};
use host::scene_gpu::SceneGpu;
use shadows::glam::Vec3;
use shadows::{
    Blob, BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor,
    DirectionalLight, wgpu,
};

use crate::sides::{kept_vs_moving, many_vs_few, places};

const SIZE: [u32; 2] = [1280, 720];

fn sun() -> BlobLight {
    BlobLight::new(DirectionalLight::new(Vec3::new(0.4, 1.0, 0.3)), 0.05, 1.0)
}

fn new(gpu: &Gpu) -> BlobShadow {
    let descriptor = BlobShadowDescriptor {
        decals: Some(BlobDecalDescriptor::default()),
        ..Default::default()
    };
    BlobShadow::new(&gpu.device, &descriptor).expect("the descriptor is in range")
}

/// The empty floor of the scene.
fn empty() -> Scene {
    let mut scene = floor();
    scene.objects.truncate(1);
    scene
}

/// So many in rows on the floor.
fn rows(count: usize) -> Vec<Blob> {
    let (places, radius) = places(count);
    places.map(|place| Blob::sphere(place, radius)).collect()
}

pub fn decals(gpu: &Gpu, rounds: u32) {
    let scene = empty();
    let scene_gpu = SceneGpu::new(gpu, &scene).expect("the scene fits");
    let host = Renderer::new(gpu, SIZE, &scene, &scene_gpu).expect("the targets fit");
    gpu.run(|encoder| host.draw_ambient(encoder, &scene_gpu));
    let mask = gpu.target(SIZE, wgpu::TextureFormat::R8Unorm, 1);
    let mask = mask.create_view(&Default::default());
    let of = |count| {
        let mut blobs = new(gpu);
        let frame = BlobFrame {
            lights: &[sun()],
            views: &[view(&scene, SIZE).expect("the camera makes a view")],
            blobs: &rows(count),
            ..Default::default()
        };
        blobs
            .prepare(&gpu.device, &gpu.queue, &frame)
            .expect("the frame is in range");
        gpu.run(|encoder| blobs.encode(encoder));
        let depth = blobs
            .decal_bind_group(&gpu.device, host.depth_stencil())
            .expect("the depth can be read");
        (blobs, depth)
    };
    many_vs_few("blob_decals_10000_vs_1000", rounds, of, |(blobs, depth)| {
        gpu.run(|encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &mask,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            blobs.render(&mut pass, 0, 0, depth).expect("it is encoded");
        });
    });
}

pub fn prepares(gpu: &Gpu, rounds: u32) {
    let [mut kept, mut moved] = [new(gpu), new(gpu)];
    let sides = [&mut kept, &mut moved];
    kept_vs_moving(
        "blob_prepare_kept_vs_moving",
        gpu,
        rounds,
        sides,
        |blobs, casters| {
            let frame = BlobFrame {
                lights: &[sun()],
                casters,
                ..Default::default()
            };
            let start = Instant::now();
            blobs
                .prepare(&gpu.device, &gpu.queue, &frame)
                .expect("the frame is in range");
            let time = start.elapsed();
            gpu.run(|encoder| blobs.encode(encoder));
            time
        },
    );
    assert_eq!(kept.statistics().uploaded, 0);
}
