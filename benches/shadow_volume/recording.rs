//! What it costs to record the search for silhouettes.
//!
//! A thousand boxes that all move in every frame, the silhouettes found by compute shaders, `encode` and the
//! end of its encoder alone:
//! - `ratio record_1000_meshes_vs_10`: each with a mesh of its own, over all of ten meshes.
//! - `ratio dispatches_1000_meshes_vs_10`: the dispatches of the same.

use std::time::Instant;

use host::gpu::Gpu;
use host::one_light::{OneLight, PrepareOne as _};
use host::shapes;
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    Caster, CasterMesh, DepthConvention, HomogeneousLight, ShadowVolumeDescriptor,
    ShadowVolumeRenderer, Silhouettes, View, wgpu,
};

use crate::shared::{median, paired};

const COUNT: usize = 1000;

struct Crowd {
    renderer: ShadowVolumeRenderer,
    casters: Vec<Caster>,
}

impl Crowd {
    fn new(gpu: &Gpu, meshes: &[CasterMesh]) -> Self {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
            silhouettes: Silhouettes::Compute,
            ..Default::default()
        };
        let place = |n: usize| {
            let at = Vec3::new((n % 32) as f32 * 0.2, 1.0, (n / 32) as f32 * 0.2);
            Affine3A::from_translation(at - 3.2) * Affine3A::from_scale(Vec3::splat(0.04))
        };
        let caster = |n: usize| Caster::new(meshes[n % meshes.len()].clone(), place(n));
        Self {
            renderer: ShadowVolumeRenderer::new(&gpu.device, &descriptor).expect("a device"),
            casters: (0..COUNT).map(caster).collect(),
        }
    }

    /// Seconds in which a frame's search is recorded.
    fn record(&mut self, gpu: &Gpu, view: &View) -> f64 {
        for caster in &mut self.casters {
            caster.world_from_object.translation.y += 1e-3;
        }
        let light = HomogeneousLight::point(Vec3::new(-2.0, 6.0, 2.5));
        let frame = OneLight::new(view, light, &self.casters);
        self.renderer
            .prepare_one(&gpu.device, &gpu.queue, &frame)
            .expect("a frame");
        let searched = self.renderer.statistics().casters_extracted;
        assert_eq!(searched as usize, COUNT);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let start = Instant::now();
        self.renderer.encode(&mut encoder);
        let commands = encoder.finish();
        let time = start.elapsed();
        gpu.queue.submit([commands]);
        gpu.wait();
        time.as_secs_f64()
    }
}

/// Measures and prints.
pub fn run(gpu: &Gpu, rounds: usize) {
    let camera = view::look_at_mat4(Vec3::new(0.0, 9.0, 12.0), Vec3::ZERO, Vec3::Y);
    let projection = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
    let view = View::new(projection * camera, DepthConvention::InfiniteReverse).expect("a view");
    let shape = shapes::cube();
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).expect("a box");
    let mesh = |_| CasterMesh::new(&gpu.device, &shape.positions, &adjacency).expect("a mesh");
    let meshes: Vec<CasterMesh> = (0..COUNT).map(mesh).collect();
    let mut crowds = [&meshes[..], &meshes[..10]].map(|meshes| Crowd::new(gpu, meshes));
    let mut times = [const { Vec::new() }; 2];
    for round in 0..=rounds {
        for (crowd, times) in crowds.iter_mut().zip(&mut times) {
            let time = crowd.record(gpu, &view);
            // The first round allocates.
            if round > 0 {
                times.push(time);
            }
        }
    }
    let [many, few] = &times;
    let microseconds = |times: &[f64]| 1e6 * median(times.iter().copied());
    println!(
        "recorded: {COUNT} boxes of as many meshes {:.0} us, of ten {:.0} us",
        microseconds(many),
        microseconds(few)
    );
    println!("ratio record_1000_meshes_vs_10 {:.3}", paired(many, few));
    let [many, few] = crowds.map(|crowd| crowd.renderer.statistics().dispatches);
    println!(
        "ratio dispatches_1000_meshes_vs_10 {:.3}",
        f64::from(many) / f64::from(few)
    );
}
