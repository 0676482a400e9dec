//! Large meshes, and meshes that a quadratic step would take minutes for: 200,000 elements are some
//! 100,000 times the work of a linear one, which no test run survives unnoticed.

use shadows::mesh::{Adjacency, MeshKind};

use crate::shapes::{Mesh, Random, fins, torus};

const TRIANGLES: u32 = 200_000;

fn build(mesh: &Mesh, tolerance: f32) -> Adjacency {
    Adjacency::with_tolerance(&mesh.positions, &mesh.indices, tolerance).unwrap()
}

#[test]
fn two_million_triangles_keep_eulers_formula() {
    let mesh = torus(1000, 1000);
    let adjacency = build(&mesh, 0.0);
    assert_eq!(adjacency.kind(), MeshKind::Closed);
    let counts = [
        mesh.positions.len(),
        adjacency.edges().len(),
        adjacency.triangles().len(),
    ];
    assert_eq!(counts, [1_000_000, 3_000_000, 2_000_000]);
    assert_eq!(adjacency.topology().to_string(), "closed, 1 part");

    let mut twin = mesh;
    twin.remove(1_234_567);
    let topology = *build(&twin, 0.0).topology();
    assert_eq!(topology.to_string(), "not closed, 1 part, 3 open edges");
}

#[test]
fn very_many_fins_on_one_edge_are_no_hardship() {
    for alternate in [false, true] {
        let adjacency = build(&fins(TRIANGLES, alternate), 0.0);
        assert_eq!(adjacency.topology().non_manifold_edges, 1);
        assert_eq!(adjacency.edges()[0].use_count, TRIANGLES);
        let mesh = fins(TRIANGLES, alternate);
        let raw = Adjacency::from_raw(&mesh.positions, adjacency.indices()).unwrap();
        assert_eq!(raw.edges().len(), adjacency.edges().len());
    }
}

#[test]
fn a_fan_around_one_vertex_is_no_hardship() {
    // Around the lowest vertex, which has every edge in its bucket, and around the highest.
    for hub in [0, TRIANGLES] {
        let mut mesh = Mesh::default();
        for i in 0..=TRIANGLES {
            let (s, c) = (i as f32 * 1e-5).sin_cos();
            mesh.positions.push([i as f32, s, c]);
        }
        let rim = |i: u32| {
            if hub == 0 {
                i % TRIANGLES + 1
            } else {
                i % TRIANGLES
            }
        };
        for i in 0..TRIANGLES {
            mesh.indices.extend([hub, rim(i), rim(i + 1)]);
        }
        let adjacency = build(&mesh, 0.0);
        assert_eq!(adjacency.topology().open_edges, TRIANGLES);
        assert_eq!(adjacency.topology().parts, 1);
    }
}

#[test]
fn one_triangle_many_times_is_no_hardship() {
    let mesh = Mesh {
        positions: vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]],
        indices: [0, 1, 2].repeat(TRIANGLES as usize),
    };
    let adjacency = build(&mesh, 0.0);
    assert_eq!(adjacency.topology().duplicate_triangles, TRIANGLES - 1);
}

#[test]
fn a_crowd_within_the_tolerance_is_no_hardship() {
    // All in one cell but for one far away, which makes the mesh large; then all at one place.
    for spread in [1e-3, 0.0] {
        let mut random = Random(11);
        let mut mesh = Mesh::default();
        for _ in 0..TRIANGLES {
            mesh.positions
                .push([(); 3].map(|()| spread * random.signed()));
        }
        mesh.positions.push([1.0; 3]);
        let adjacency = build(&mesh, 1e-2);
        let welded = adjacency.topology().welded_vertices;
        assert_eq!(welded, TRIANGLES - 1);
        let adjacency = build(&mesh, 1e-4);
        let welded = adjacency.topology().welded_vertices;
        assert!(welded > TRIANGLES / 2 && (spread == 0.0 || welded < TRIANGLES - 1));
    }
}
