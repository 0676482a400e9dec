//! Random meshes against two implementations that share nothing with the crate's.

use proptest::prelude::*;
use shadows::mesh::{Adjacency, MeshKind};

use crate::naive::Naive;
use crate::shapes::{Mesh, Random, band, soup, stacked_sphere, torus};

fn build(mesh: &Mesh) -> Adjacency {
    Adjacency::new(&mesh.positions, &mesh.indices).unwrap()
}

/// meshoptimizer's six indices, with this crate's value where it found no neighbour.
fn by_meshopt(mesh: &Mesh) -> Vec<u32> {
    let bytes: &[u8] = bytemuck::cast_slice(&mesh.positions);
    let vertices = meshopt::VertexDataAdapter::new(bytes, 12, 0).unwrap();
    let mut six = meshopt::generate_adjacency_indices(&mesh.indices, &vertices);
    for sextuple in six.chunks_exact_mut(6) {
        for edge in 0..3 {
            if sextuple[2 * edge + 1] == sextuple[2 * edge] {
                sextuple[2 * edge + 1] = sextuple[(2 * edge + 4) % 6];
            }
        }
    }
    six
}

/// Whether an adjacency's list of six says what another says of a mesh.
fn same_neighbours(adjacency: &Adjacency, six: &[u32]) -> bool {
    adjacency.indices() == six
}

fn closed_mesh(seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut mesh = match random.below(2) {
        0 => torus(3 + random.below(6) as u32, 3 + random.below(6) as u32),
        _ => {
            let splits = random.below(40);
            stacked_sphere(splits, &mut random)
        }
    };
    mesh.scramble(&mut random);
    mesh
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn closed_meshes_are_as_meshoptimizer_and_the_definition_have_them(seed: u64, pick: usize) {
        let mesh = closed_mesh(seed);
        let adjacency = build(&mesh);
        prop_assert_eq!(adjacency.kind(), MeshKind::Closed);
        prop_assert!(same_neighbours(&adjacency, &by_meshopt(&mesh)));
        let naive = Naive::new(&mesh);
        prop_assert_eq!(&Naive::of(&adjacency), &naive);
        for edge in adjacency.edges() {
            let uses = adjacency.uses(edge);
            prop_assert_eq!([uses[0].reversed(), uses[1].reversed()], [false, true]);
            let corners = adjacency.triangles()[uses[0].triangle() as usize];
            let [a, b] = edge.vertices;
            prop_assert!([[0, 1], [1, 2], [2, 0]].map(|e| e.map(|c| corners[c])).contains(&[a, b]));
        }

        // The broken twins: one triangle turned over, one triangle missing, one entry changed.
        let mut flipped = mesh.clone();
        flipped.flip(pick % mesh.triangle_count());
        let twin = build(&flipped);
        prop_assert_eq!(twin.kind(), MeshKind::General);
        prop_assert_ne!(&twin.topology(), &adjacency.topology());
        prop_assert_ne!(&Naive::of(&twin).edges, &naive.edges);
        let mut open = mesh.clone();
        open.remove(pick % mesh.triangle_count());
        prop_assert_eq!(build(&open).topology().open_edges, 3);
        prop_assert_ne!(&Naive::of(&build(&open)).edges, &naive.edges);
        let mut six = by_meshopt(&mesh);
        let entry = pick % six.len();
        six[entry] ^= 1;
        prop_assert!(!same_neighbours(&adjacency, &six));
    }

    #[test]
    fn soup_is_as_the_definition_has_it(
        seed: u64,
        vertices in 1usize..30,
        triangles in 0usize..60,
        side in 1usize..5,
    ) {
        let mesh = soup(vertices, triangles, side, &mut Random(seed));
        let adjacency = build(&mesh);
        let naive = Naive::new(&mesh);
        prop_assert_eq!(&Naive::of(&adjacency), &naive);
        prop_assert_eq!(adjacency.kind() == MeshKind::Closed, naive.topology.closed);
        let uses: usize = adjacency.edges().iter().map(|e| adjacency.uses(e).len()).sum();
        prop_assert_eq!(uses, adjacency.edge_uses().len());

        // The broken twin: the same soup less one triangle that did not collapse.
        let solid = mesh.indices.chunks_exact(3).position(|corners| {
            let welded = [0, 1, 2].map(|c| naive.representatives[corners[c] as usize]);
            naive.triangles.first() == Some(&welded)
        });
        if let Some(triangle) = solid {
            let mut twin = mesh.clone();
            twin.remove(triangle);
            let twin = Naive::of(&build(&twin));
            prop_assert_ne!(&twin.edges, &naive.edges);
        }
    }

    #[test]
    fn where_a_triangle_runs_the_other_way_soup_is_as_meshoptimizer_has_it(
        seed: u64,
        vertices in 4usize..30,
        triangles in 1usize..60,
    ) {
        // Without collapsed triangles, which meshoptimizer keeps, and with positions all different.
        let mut mesh = soup(vertices, triangles, 4, &mut Random(seed));
        for (i, position) in mesh.positions.iter_mut().enumerate() {
            position[0] = (i / 2) as f32 + 1.0;
        }
        let welded = Naive::new(&mesh).representatives;
        let kept = mesh.indices.chunks_exact(3).filter(|t| {
            let [a, b, c] = [0, 1, 2].map(|corner| welded[t[corner] as usize]);
            a != b && b != c && c != a
        });
        mesh.indices = kept.flatten().copied().collect();
        let adjacency = build(&mesh);
        let theirs = by_meshopt(&mesh);
        let mut compared = 0;
        for (place, (&own, &other)) in adjacency.indices().iter().zip(&theirs).enumerate() {
            let sextuple = &theirs[place / 6 * 6..][..6];
            let found = place % 2 == 1 && other != sextuple[(place % 6 + 3) % 6];
            if place % 2 == 0 || found {
                prop_assert_eq!(own, other);
                compared += 1;
            }
        }
        prop_assert!(compared >= mesh.indices.len());
    }
}

#[test]
fn open_bands_are_as_meshoptimizer_has_them() {
    let mesh = band(12, false);
    let adjacency = build(&mesh);
    assert!(same_neighbours(&adjacency, &by_meshopt(&mesh)));
    assert_eq!(Naive::of(&adjacency), Naive::new(&mesh));

    // The broken twin: meshoptimizer does not look for neighbours that run the same way.
    let twisted = band(12, true);
    let adjacency = build(&twisted);
    assert!(!same_neighbours(&adjacency, &by_meshopt(&twisted)));
    assert_eq!(Naive::of(&adjacency), Naive::new(&twisted));
}
