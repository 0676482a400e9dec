//! How long adjacency takes to build, beside meshoptimizer in the same run.
//!
//! Both get a closed torus of a million triangles: with shared vertices, with every triangle's own
//! (as after splitting for flat normals), and with vertices and triangles in random order, which
//! no cache likes.
//!
//! - meshoptimizer's `generateAdjacencyIndexBuffer`: welds by hashing positions, hashes each
//!   half-edge, writes six indices a triangle.
//! - `Adjacency::new`: checks the input, welds by hashing positions (-0 equals +0), sorts
//!   half-edges into edges with all their uses, writes six indices a triangle, finds triangles
//!   without area and duplicates, counts parts and reports.
//!
//! The last lines compare them in interleaved rounds, so that a machine that slows down slows
//! both: `ratio build_vs_meshopt` is the largest of the meshes' medians of rounds.
//! `--quick` takes fewer rounds.

#[path = "shared/mod.rs"]
mod shared;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, SamplingMode};
use shadows::mesh::{Adjacency, MeshKind};
use shared::torus::torus;

struct Mesh {
    name: &'static str,
    positions: Vec<[f32; 3]>,
    indices: Vec<u32>,
}

fn split(mesh: &Mesh) -> Mesh {
    Mesh {
        name: "split",
        positions: mesh
            .indices
            .iter()
            .map(|&i| mesh.positions[i as usize])
            .collect(),
        indices: (0..mesh.indices.len() as u32).collect(),
    }
}

fn shuffled(mesh: &Mesh) -> Mesh {
    // Knuth's linear congruential generator (MMIX); its top bits are good enough for a shuffle.
    let mut state = 1u64;
    let mut below = |limit: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % limit as u64) as usize
    };
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for last in (1..order.len()).rev() {
        order.swap(last, below(last + 1));
    }
    let mut positions = mesh.positions.clone();
    for (&to, &position) in order.iter().zip(&mesh.positions) {
        positions[to as usize] = position;
    }
    let corners = mesh.indices.chunks_exact(3);
    let mut triangles: Vec<[u32; 3]> = corners
        .map(|t| [0, 1, 2].map(|corner| order[t[corner] as usize]))
        .collect();
    for last in (1..triangles.len()).rev() {
        triangles.swap(last, below(last + 1));
    }
    Mesh {
        name: "shuffled",
        positions,
        indices: triangles.into_flattened(),
    }
}

fn ours(mesh: &Mesh) -> Adjacency {
    Adjacency::new(black_box(&mesh.positions), black_box(&mesh.indices)).expect("a sound mesh")
}

fn theirs(mesh: &Mesh) -> Vec<u32> {
    let bytes: &[u8] = bytemuck::cast_slice(black_box(&mesh.positions));
    let vertices = meshopt::VertexDataAdapter::new(bytes, 12, 0).expect("whole positions");
    meshopt::generate_adjacency_indices(black_box(&mesh.indices), &vertices)
}

/// One over the other, in rounds that take turns.
fn compare(mesh: &Mesh, rounds: usize) -> f64 {
    let time = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed()
    };
    let (mut own, mut other) = (Vec::new(), Vec::new());
    for _ in 0..rounds {
        own.push(time(&mut || drop(black_box(ours(mesh)))));
        other.push(time(&mut || drop(black_box(theirs(mesh)))));
    }
    let [own, other] = [own, other].map(|times| shared::seconds(&times));
    let ratio = shared::paired(&own, &other);
    let median = |times| 1e3 * shared::median(times);
    println!(
        "{} vertices: ours {:.1} ms, meshopt {:.1} ms, {ratio:.3} times",
        mesh.name,
        median(own),
        median(other)
    );
    ratio
}

fn main() {
    let (positions, indices) = torus(1000, 500);
    let shared = Mesh {
        name: "shared",
        positions,
        indices,
    };
    let meshes = [split(&shared), shuffled(&shared), shared];
    for mesh in &meshes {
        assert_eq!(ours(mesh).kind(), MeshKind::Closed);
        assert_eq!(ours(mesh).indices(), theirs(mesh), "both find the same");
    }
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(3))
        .configure_from_args();
    let mut group = criterion.benchmark_group("adjacency of a million triangles");
    group.sampling_mode(SamplingMode::Flat);
    for mesh in &meshes {
        group.bench_function(format!("ours, {}", mesh.name), |b| b.iter(|| ours(mesh)));
        group.bench_function(format!("meshopt, {}", mesh.name), |b| {
            b.iter(|| theirs(mesh))
        });
    }
    group.finish();
    criterion.final_summary();
    let rounds = if shared::quick() { 5 } else { 21 };
    let ratios = meshes.iter().map(|mesh| compare(mesh, rounds));
    println!("ratio build_vs_meshopt {:.3}", ratios.fold(0.0, f64::max));
}
