//! What it costs that casters have meshes of their own, and what a change in the list costs.
//!
//! Four thousand boxes that all move in every frame, the silhouettes found by default:
//! - `ratio distinct_meshes_4000_vs_one_mesh`: each with a mesh of its own, over all of one mesh: a
//!   frame's `prepare`, `encode` and `render`, until the device is done.
//!
//! Then they stand still, and the first of them goes or comes by turns:
//! - `ratio first_of_4000_vs_all_moving`: `prepare` alone, over `prepare` where all move.
//! - `ratio searched_for_the_first`: silhouettes searched for each time it comes, which must be 1, and
//!   none where it goes.

use std::time::Instant;

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    Caster, CasterMesh, DepthConvention, HomogeneousLight, ShadowVolumeDescriptor,
    ShadowVolumeRenderer, View, wgpu,
};

use crate::shared::{median, paired};
use host::gpu::Gpu;
use host::shapes;

const COUNT: usize = 4000;
const SIZE: [u32; 2] = [320, 180];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth24PlusStencil8;

struct Crowd<'a> {
    gpu: &'a Gpu,
    renderer: ShadowVolumeRenderer,
    casters: Vec<Caster>,
    view: View,
    target: wgpu::TextureView,
}

impl<'a> Crowd<'a> {
    fn new(gpu: &'a Gpu, meshes: &[CasterMesh]) -> Self {
        let camera = view::look_at_mat4(Vec3::new(0.0, 9.0, 12.0), Vec3::ZERO, Vec3::Y);
        let projection = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: FORMAT,
            ..Default::default()
        };
        let place = |n: usize| {
            let at = Vec3::new(
                (n % 64) as f32 * 0.1 - 3.2,
                1.0,
                (n / 64) as f32 * 0.1 - 3.2,
            );
            Affine3A::from_translation(at) * Affine3A::from_scale(Vec3::splat(0.02))
        };
        let casters = (0..COUNT).map(|n| Caster::new(meshes[n % meshes.len()].clone(), place(n)));
        Self {
            gpu,
            renderer: ShadowVolumeRenderer::new(&gpu.device, &descriptor).expect("a device"),
            casters: casters.collect(),
            view: View::new(projection * camera, DepthConvention::InfiniteReverse).expect("a view"),
            target: gpu
                .target(SIZE, FORMAT, 1)
                .create_view(&wgpu::TextureViewDescriptor::default()),
        }
    }

    /// Seconds of `prepare`, and of all of a frame.
    fn frame(&mut self) -> [f64; 2] {
        let light = HomogeneousLight::point(Vec3::new(-2.0, 6.0, 2.5));
        let frame = OneLight::new(&self.view, light, &self.casters);
        let start = Instant::now();
        self.renderer
            .prepare_one(&self.gpu.device, &self.gpu.queue, &frame)
            .expect("a frame");
        let prepare = start.elapsed();
        self.gpu.run(|encoder| {
            self.renderer.encode(encoder);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.target,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0),
                        store: wgpu::StoreOp::Store,
                    }),
                }),
                ..Default::default()
            });
            self.renderer
                .render(&mut pass, 0, 0)
                .expect("it is encoded");
        });
        [prepare, start.elapsed()].map(|time| time.as_secs_f64())
    }

    fn move_all(&mut self) {
        for caster in &mut self.casters {
            caster.world_from_object.translation.y += 1e-3;
        }
    }
}

/// Measures and prints.
pub fn run(gpu: &Gpu, rounds: usize) {
    let shape = shapes::cube();
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).expect("a box");
    let mesh = || CasterMesh::new(&gpu.device, &shape.positions, &adjacency).expect("a mesh");
    let meshes: Vec<CasterMesh> = (0..COUNT).map(|_| mesh()).collect();
    let mut crowds = [&meshes[..], &meshes[..1]].map(|meshes| Crowd::new(gpu, meshes));
    let mut times = [const { Vec::new() }; 2];
    let mut moving = Vec::new();
    for round in 0..=rounds {
        for (place, crowd) in crowds.iter_mut().enumerate() {
            crowd.move_all();
            let [prepare, all] = crowd.frame();
            let searched = crowd.renderer.statistics().casters_extracted;
            assert_eq!(searched as usize, COUNT);
            // The first round allocates.
            if round > 0 {
                times[place].push(all);
                moving.extend((place == 0).then_some(prepare));
            }
        }
    }
    let [distinct, one] = &times;
    let crowd = &mut crowds[0];
    let (mut kept, mut searched) = (Vec::new(), 0);
    for _ in 0..rounds {
        let first = crowd.casters.remove(0);
        kept.push(crowd.frame()[0]);
        assert_eq!(crowd.renderer.statistics().casters_extracted, 0);
        crowd.casters.insert(0, first);
        crowd.frame();
        searched += crowd.renderer.statistics().casters_extracted;
    }
    let milliseconds = |times: &[f64]| 1e3 * median(times.iter().copied());
    println!(
        "{COUNT} meshes {:.2} ms, one mesh {:.2} ms; prepare {:.2} ms where all move, {:.2} where the \
         first goes",
        milliseconds(distinct),
        milliseconds(one),
        milliseconds(&moving),
        milliseconds(&kept)
    );
    println!(
        "ratio distinct_meshes_4000_vs_one_mesh {:.3}",
        paired(distinct, one)
    );
    println!(
        "ratio first_of_4000_vs_all_moving {:.3}",
        paired(&kept, &moving)
    );
    println!(
        "ratio searched_for_the_first {:.3}",
        f64::from(searched) / rounds as f64
    );
}
