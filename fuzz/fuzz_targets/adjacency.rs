//! Adjacency of any triangles, welded with any tolerance.
#![no_main]

use libfuzzer_sys::fuzz_target;
use shadows::mesh::Adjacency;
use shadows_fuzz::Number;
use shadows_fuzz::mesh::{Mesh, check};

fuzz_target!(|input: (Mesh, Number)| {
    let (mesh, Number(tolerance)) = input;
    let positions = mesh.positions();
    let _ = Adjacency::new(&positions, &mesh.indices());
    let indices = mesh.whole_triangles();
    if let Ok(adjacency) = Adjacency::with_tolerance(&positions, &indices, tolerance) {
        check(&adjacency, &indices);
        check_distances(&positions, &adjacency, tolerance);
    }
});

/// No vertex moves farther than the tolerance, and representatives stay farther apart.
fn check_distances(positions: &[[f32; 3]], adjacency: &Adjacency, tolerance: f32) {
    let side = |axis: usize| {
        let low = positions
            .iter()
            .map(|p| p[axis])
            .fold(f32::INFINITY, f32::min);
        let high = positions
            .iter()
            .map(|p| p[axis])
            .fold(f32::NEG_INFINITY, f32::max);
        f64::from(high) - f64::from(low)
    };
    let size = side(0).max(side(1)).max(side(2)).max(0.0);
    let most = f64::from(tolerance) * size;
    let squared = |a: u32, b: u32| -> f64 {
        let [a, b] = [a, b].map(|vertex| positions[vertex as usize].map(f64::from));
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum()
    };
    let representatives = adjacency.representatives();
    for (vertex, &representative) in (0..).zip(representatives) {
        assert!(squared(vertex, representative) <= most * most);
    }
    let own: Vec<u32> = (0..adjacency.vertex_count())
        .filter(|&vertex| representatives[vertex as usize] == vertex)
        .take(64)
        .collect();
    for (place, &a) in own.iter().enumerate() {
        for &b in &own[..place] {
            assert!(
                squared(a, b) > most * most
                    || most == 0.0 && positions[a as usize] != positions[b as usize]
            );
        }
    }
}
