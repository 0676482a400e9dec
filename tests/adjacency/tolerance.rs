//! Welding within a distance.

use proptest::prelude::*;
use shadows::mesh::{Adjacency, MeshKind};

use crate::shapes::{Random, cube_of_24};

fn representatives(positions: &[[f32; 3]], tolerance: f32) -> Vec<u32> {
    let adjacency = Adjacency::with_tolerance(positions, &[], tolerance).unwrap();
    adjacency.representatives().to_vec()
}

/// The rule by definition: each vertex against every representative before it.
fn naive(positions: &[[f32; 3]], tolerance: f32) -> Vec<u32> {
    let side = |axis: usize| {
        let along = positions.iter().map(|p| f64::from(p[axis]));
        along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
    };
    let limit = f64::from(tolerance) * side(0).max(side(1)).max(side(2));
    let mut found: Vec<u32> = Vec::new();
    for (vertex, position) in positions.iter().enumerate() {
        let near = (0..vertex).find(|&other| {
            let squares = (0..3).map(|axis| {
                (f64::from(positions[other][axis]) - f64::from(position[axis])).powi(2)
            });
            found[other] == other as u32 && squares.sum::<f64>() <= limit * limit
        });
        found.push(near.unwrap_or(vertex) as u32);
    }
    found
}

/// Clusters of points at every scale from the whole mesh down to single ulps.
fn clusters(seed: u64, count: usize, offset: f32, scale: f32) -> Vec<[f32; 3]> {
    let mut random = Random(seed);
    let mut positions: Vec<[f32; 3]> = Vec::new();
    for _ in 0..count {
        let spread = 10f32.powi(-(random.below(9) as i32));
        let near = match positions.len() {
            0 => [offset; 3],
            some => positions[random.below(some)],
        };
        positions.push(near.map(|x| x + spread * random.signed()));
    }
    positions.iter().map(|p| p.map(|x| x * scale)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn the_grid_finds_what_the_definition_finds(
        seed: u64,
        count in 1usize..200,
        exponent in 0i32..46,
        offset in prop::sample::select(vec![0.0, 1.0, 1e3, -1e6]),
        scale in prop::sample::select(vec![1.0, 1e-30, 1e30]),
    ) {
        let tolerance = 0.5 * 10f64.powi(-exponent) as f32;
        let positions = clusters(seed, count, offset, scale);
        let expected = naive(&positions, tolerance);
        prop_assert_eq!(representatives(&positions, tolerance), expected);
    }
}

#[test]
fn another_tolerance_or_another_order_gives_another_weld() {
    let mut positions = clusters(7, 200, 0.0, 1.0);
    let expected = naive(&positions, 1e-3);
    assert_eq!(representatives(&positions, 1e-3), expected);
    assert_ne!(representatives(&positions, 4e-3), expected);
    positions.reverse();
    assert_ne!(representatives(&positions, 1e-3), expected);
}

#[test]
fn a_row_of_close_vertices_does_not_collapse() {
    // Eight steps of 0.9 tolerances, the tolerance being a tenth of the row.
    let positions: Vec<[f32; 3]> = (0..=9).map(|i| [i as f32 * 0.9, 0.0, 0.0]).collect();
    let expected = [0, 0, 2, 2, 4, 4, 6, 6, 8, 8];
    assert_eq!(representatives(&positions, 1.0 / 8.1), expected);
}

#[test]
fn a_cube_with_loose_corners_closes_at_any_scale() {
    for scale in [1e-4f32, 1.0, 1e5] {
        let mut random = Random(3);
        let mut mesh = cube_of_24();
        for x in mesh.positions.iter_mut().flatten() {
            *x = scale * (*x + 1e-4 * random.signed());
        }
        let kind = |tolerance| {
            Adjacency::with_tolerance(&mesh.positions, &mesh.indices, tolerance)
                .unwrap()
                .kind()
        };
        assert_eq!(kind(1e-3), MeshKind::Closed);
        // The broken twins: nothing is close enough, or everything is.
        assert_eq!(kind(1e-6), MeshKind::General);
        assert_eq!(kind(0.0), MeshKind::General);
    }
}
