//! How long it takes to find the volume of a closed mesh of a million triangles, beside the
//! plainest loops that could do it, in interleaved rounds.
//!
//! Everyone has the same duty: from a light until the lists of caps and sides lie in the GPU's
//! buffers and its queue is idle. (A list in main memory is of no use to a draw.) The light moves
//! every round.
//!
//! - `extraction`: `Silhouettes::Auto`, `prepare` and `encode`.
//! - `loop`: one thread and no rounding analysis: a byte of facing a triangle from its plain normal,
//!   then a look at each edge, then `write_buffer` for both lists. Its share before `write_buffer` is
//!   printed beside it, and `ratio extraction_vs_loop_in_memory` is over that alone.
//! - `compute`: `Silhouettes::Compute`, the same two phases as plain compute passes.
//! - `copy`: the adapter copies as many bytes as an extraction has to read, the floor.
//!
//! `ratio extraction_vs_best_loop` is `extraction` over the faster of `loop` and `compute`.

use std::hint::black_box;
use std::time::{Duration, Instant};

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    Caster, CasterMesh, DepthConvention, HomogeneousLight, ShadowVolumeDescriptor,
    ShadowVolumeRenderer, Silhouettes, View, wgpu,
};

use crate::shared::torus::torus;
use crate::shared::{median, paired, seconds};
use host::gpu::{self, Gpu};

/// The plain loop and its memory.
struct Loop {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Two triangles an edge.
    edges: Vec<[u32; 2]>,
    facings: Vec<u8>,
    caps: Vec<u32>,
    sides: Vec<u32>,
    /// Of caps and sides, room for all there could be.
    buffers: [wgpu::Buffer; 2],
    /// Milliseconds without the upload.
    in_memory: Vec<Duration>,
}

impl Loop {
    fn upload(&mut self, gpu: &Gpu, light: Vec3) {
        let start = Instant::now();
        self.run(light);
        self.in_memory.push(start.elapsed());
        for (buffer, words) in self.buffers.iter().zip([&self.caps, &self.sides]) {
            gpu.queue
                .write_buffer(buffer, 0, bytemuck::cast_slice(words));
        }
        gpu.run(|_| {});
    }

    fn run(&mut self, light: Vec3) {
        self.facings.clear();
        self.caps.clear();
        self.sides.clear();
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|v| self.positions[v as usize]);
            let faces = (b - a).cross(c - a).dot(light - a) > 0.0;
            self.facings.push(u8::from(faces));
            if faces {
                self.caps.extend(corners);
            }
        }
        for (edge, &[there, back]) in (0u32..).zip(&self.edges) {
            let (there, back) = (self.facings[there as usize], self.facings[back as usize]);
            if there != back {
                self.sides.push(edge << 1 | u32::from(there < back));
            }
        }
        black_box((&self.caps, &self.sides));
    }
}

struct Extraction<'a> {
    gpu: &'a Gpu,
    renderer: ShadowVolumeRenderer,
    casters: Vec<Caster>,
    view: View,
}

impl<'a> Extraction<'a> {
    fn new(gpu: &'a Gpu, mesh: &CasterMesh, silhouettes: Silhouettes) -> Self {
        let camera = view::look_at_mat4(Vec3::new(0.0, 9.0, 12.0), Vec3::ZERO, Vec3::Y);
        let projection = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
        let descriptor = ShadowVolumeDescriptor {
            silhouettes,
            ..Default::default()
        };
        Self {
            gpu,
            renderer: ShadowVolumeRenderer::new(&gpu.device, &descriptor).expect("a device"),
            casters: vec![Caster::new(mesh.clone(), Affine3A::IDENTITY)],
            view: View::new(projection * camera, DepthConvention::InfiniteReverse).expect("a view"),
        }
    }

    fn run(&mut self, light: Vec3) {
        let light = HomogeneousLight::point(light);
        let frame = OneLight::new(&self.view, light, &self.casters);
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        self.renderer
            .prepare_one(device, queue, &frame)
            .expect("a frame");
        assert_eq!(self.renderer.statistics().casters_extracted, 1);
        self.gpu.run(|encoder| self.renderer.encode(encoder));
    }
}

/// Measures and prints.
pub fn run(gpu: &Gpu, rounds: usize) {
    let (positions, indices) = torus(1000, 500);
    let adjacency = Adjacency::new(&positions, &indices).expect("a torus");
    let mesh = CasterMesh::new(&gpu.device, &positions, &adjacency).expect("a mesh");
    let buffer = |bytes: usize, usage| {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("bench"),
            size: bytes as u64,
            usage,
            mapped_at_creation: false,
        })
    };
    let triangle = |use_: &shadows::mesh::EdgeUse| use_.triangle();
    let mut plain = Loop {
        positions: positions.iter().map(|&p| p.into()).collect(),
        triangles: adjacency.triangles().to_vec(),
        edges: adjacency
            .edges()
            .iter()
            .map(|edge| [0, 1].map(|i| triangle(&adjacency.uses(edge)[i])))
            .collect(),
        facings: Vec::new(),
        caps: Vec::new(),
        sides: Vec::new(),
        buffers: [3 * adjacency.triangles().len(), adjacency.edges().len()].map(|words| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
            buffer(4 * words, usage)
        }),
        in_memory: Vec::new(),
    };
    let mut auto = Extraction::new(gpu, &mesh, Silhouettes::Auto);
    let mut compute = Extraction::new(gpu, &mesh, Silhouettes::Compute);
    let bytes = 12 * positions.len() + 12 * adjacency.triangles().len() + 16 * plain.edges.len();
    let from = buffer(bytes, wgpu::BufferUsages::COPY_SRC);
    let to = buffer(bytes, wgpu::BufferUsages::COPY_DST);

    let mut times: [Vec<Duration>; 4] = Default::default();
    for round in 0..=rounds {
        let light = Vec3::new(-2.0 + 0.01 * round as f32, 6.0, 2.5);
        let works: [&mut dyn FnMut(); 4] = [
            &mut || auto.run(light),
            &mut || plain.upload(gpu, light),
            &mut || compute.run(light),
            &mut || {
                gpu.run(|encoder| {
                    encoder.copy_buffer_to_buffer(&from, 0, &to, 0, bytes as u64);
                });
            },
        ];
        for (times, work) in times.iter_mut().zip(works) {
            let start = Instant::now();
            work();
            // The first round allocates.
            if round > 0 {
                times.push(start.elapsed());
            }
        }
    }
    let in_memory = seconds(&plain.in_memory[1..]);
    let [auto, looped, compute, copy] = times.map(|times| seconds(&times));
    let milliseconds = |times: &[f64]| 1e3 * median(times.iter().copied());
    let [loop_time, compute_time] = [&looped, &compute].map(|times| milliseconds(times));
    println!(
        "{} triangles, adapter {}, clock wall",
        adjacency.triangles().len(),
        gpu::describe(&gpu.info)
    );
    println!(
        "extraction {:.2} ms, loop {loop_time:.2} ms ({:.2} in memory), compute {compute_time:.2} ms",
        milliseconds(&auto),
        milliseconds(&in_memory),
    );
    println!("copy of {bytes} bytes {:.2} ms", milliseconds(&copy));
    let best = match loop_time < compute_time {
        true => &looped,
        false => &compute,
    };
    let others = [
        ("best_loop", best),
        ("loop_in_memory", &in_memory),
        ("copy", &copy),
    ];
    for (name, other) in others {
        println!("ratio extraction_vs_{name} {:.3}", paired(&auto, other));
    }
}
