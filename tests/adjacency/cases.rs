//! One small mesh for each thing that can be odd about a mesh.

use std::collections::BTreeSet;

use shadows::mesh::{Adjacency, MeshKind, Topology};

use crate::naive::Naive;
use crate::shapes::{Mesh, band, cube, cube_of_24, fins, torus};

/// Builds and compares with the definition, whatever else the test says.
fn build(mesh: &Mesh) -> Adjacency {
    let adjacency = Adjacency::new(&mesh.positions, &mesh.indices).unwrap();
    assert_eq!(Naive::of(&adjacency), Naive::new(mesh));
    adjacency
}

fn report(set: impl Fn(&mut Topology)) -> Topology {
    let mut topology = Topology::default();
    set(&mut topology);
    topology
}

/// Each edge as its two ends' positions.
fn edges_in_space(mesh: &Mesh, adjacency: &Adjacency) -> BTreeSet<[[i32; 3]; 2]> {
    let at = |v: u32| mesh.positions[v as usize].map(|x| (x * 16.0) as i32);
    let edges = adjacency.edges().iter().map(|edge| edge.vertices.map(at));
    edges.map(|[a, b]| [a.min(b), a.max(b)]).collect()
}

#[test]
fn a_cube_of_24_vertices_is_the_cube_of_8() {
    let (small, large) = (cube(), cube_of_24());
    let [of_8, of_24] = [&small, &large].map(build);
    assert_eq!(*of_8.topology(), report(|t| t.parts = 1));
    assert_eq!(
        *of_24.topology(),
        report(|t| (t.parts, t.welded_vertices) = (1, 16))
    );
    assert_eq!(of_24.edges().len(), 18);
    assert_eq!(
        edges_in_space(&small, &of_8),
        edges_in_space(&large, &of_24)
    );
    // The neighbours are the host's own vertices: at the same places, by the other indices.
    let places = |mesh: &Mesh, adjacency: &Adjacency| -> Vec<[f32; 3]> {
        let indices = adjacency.indices().iter();
        indices.map(|&i| mesh.positions[i as usize]).collect()
    };
    assert_eq!(places(&small, &of_8), places(&large, &of_24));
    assert!(of_24.indices().contains(&23));
    assert_eq!(of_24.representatives().iter().max(), Some(&7));

    // The broken twin: one vertex a little off its place opens the cube.
    let mut twin = large.clone();
    twin.positions[23][0] += f32::EPSILON;
    assert_eq!(build(&twin).kind(), MeshKind::General);
}

#[test]
fn minus_zero_is_zero() {
    let mut mesh = cube_of_24();
    let negative = mesh.positions.iter().flatten();
    assert!(negative.clone().any(|x| x.to_bits() == (-0.0f32).to_bits()));
    assert!(negative.clone().any(|x| x.to_bits() == 0));
    assert_eq!(build(&mesh).kind(), MeshKind::Closed);

    // The broken twin: the smallest number next to zero is not zero.
    for x in mesh.positions.iter_mut().flatten() {
        if x.to_bits() == (-0.0f32).to_bits() {
            *x = -f32::from_bits(1);
        }
    }
    assert_eq!(build(&mesh).kind(), MeshKind::General);
}

#[test]
fn an_open_quad_folds_back_at_its_border() {
    let quad = Mesh {
        positions: vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]],
        indices: vec![0, 1, 2, 0, 2, 3],
    };
    let adjacency = build(&quad);
    assert_eq!(adjacency.indices(), [0, 2, 1, 0, 2, 3, 0, 1, 2, 0, 3, 2]);
    let expected = report(|t| (t.closed, t.open_edges, t.parts) = (false, 4, 1));
    assert_eq!(*adjacency.topology(), expected);
    assert_eq!(adjacency.kind(), MeshKind::General);
}

#[test]
fn fins_on_one_edge_are_all_its_uses() {
    for (alternate, neighbours) in [(true, [3, 2, 3]), (false, [3, 2, 2])] {
        let adjacency = build(&fins(3, alternate));
        let expected = report(|t| {
            (t.closed, t.open_edges, t.non_manifold_edges, t.parts) = (false, 6, 1, 1);
        });
        assert_eq!(*adjacency.topology(), expected);
        let edge = adjacency.edges().iter().find(|e| e.vertices == [0, 1]);
        let uses = adjacency.uses(edge.unwrap()).iter();
        let uses: Vec<_> = uses.map(|u| (u.triangle(), u.reversed())).collect();
        assert_eq!(uses, [(0, false), (1, alternate), (2, false)]);
        let across = [0, 1, 2].map(|fin| adjacency.indices()[6 * fin + 1]);
        assert_eq!(across, neighbours);
    }
}

#[test]
fn a_half_turned_over_is_inconsistent_along_the_seams() {
    let mut mesh = torus(8, 6);
    for triangle in 0..mesh.triangle_count() / 2 {
        mesh.flip(triangle);
    }
    let adjacency = build(&mesh);
    // Two seams of six edges; the winding is sound everywhere else.
    let expected = report(|t| (t.closed, t.inconsistent_edges, t.parts) = (false, 12, 1));
    assert_eq!(*adjacency.topology(), expected);
}

#[test]
fn a_moebius_strip_cannot_be_wound() {
    let strip = build(&band(16, true));
    let ring = build(&band(16, false));
    assert_eq!(strip.topology().inconsistent_edges, 1);
    assert_eq!(ring.topology().inconsistent_edges, 0);
    assert_eq!(strip.topology().open_edges, ring.topology().open_edges);
}

#[test]
fn duplicates_are_counted_once_each() {
    let mut mesh = cube();
    mesh.indices.extend([7, 5, 4, 5, 4, 7, 0, 1, 5]);
    let topology = *build(&mesh).topology();
    assert_eq!(topology.duplicate_triangles, 3);
    assert!(!topology.closed);

    // A sheet of two sides is closed: its triangles face opposite ways, wherever the light is.
    let sheet = Mesh {
        positions: cube().positions,
        indices: vec![0, 1, 2, 2, 1, 0],
    };
    let topology = *build(&sheet).topology();
    assert_eq!(
        topology,
        report(|t| (t.duplicate_triangles, t.unused_vertices, t.parts) = (1, 5, 1))
    );
}

#[test]
fn degenerate_triangles_are_told_apart() {
    let mut mesh = cube();
    mesh.positions.extend([[0.5, 0., 0.], [0., 0., 0.]]);
    // A repeated index; two vertices at one place; three on one line.
    mesh.indices.extend([3, 3, 5, 0, 9, 7, 0, 8, 1]);
    let adjacency = build(&mesh);
    let topology = *adjacency.topology();
    assert_eq!(topology.collapsed_triangles, 2);
    assert_eq!(topology.zero_area_triangles, 1);
    assert_eq!(adjacency.triangles().len(), 13);
    assert_eq!(adjacency.indices().len(), 15 * 6);
    assert_eq!(adjacency.indices()[12 * 6..][..6], [3, 5, 3, 3, 5, 3]);
    // The triangle after those that collapsed keeps its host's place.
    assert_eq!(adjacency.indices()[14 * 6..][..6], [0, 1, 8, 0, 1, 5]);
}

#[test]
fn parts_share_vertices_not_only_edges() {
    let mut mesh = cube();
    let second = cube();
    let away = |shift: f32| second.positions.iter().map(move |p| p.map(|x| x + shift));
    mesh.positions.extend(away(1.0));
    mesh.positions.extend(away(5.0));
    for first in [8, 16] {
        let indices = second.indices.iter().map(|i| i + first);
        mesh.indices.extend(indices);
    }
    let topology = *build(&mesh).topology();
    // The second cube touches the first in a corner; the third stands alone.
    assert_eq!(topology, report(|t| (t.parts, t.welded_vertices) = (2, 1)));
}

#[test]
fn an_empty_mesh_is_closed() {
    for positions in [vec![], vec![[1.0f32, 2.0, 3.0]]] {
        let adjacency = Adjacency::new(&positions, &[]).unwrap();
        assert_eq!(adjacency.kind(), MeshKind::Closed);
        assert_eq!(adjacency.topology().unused_vertices, positions.len() as u32);
        assert!(adjacency.edges().is_empty() && adjacency.indices().is_empty());
    }
}

#[test]
fn the_report_reads_as_one_line() {
    assert_eq!(build(&cube()).topology().to_string(), "closed, 1 part");
    let line = build(&fins(3, false)).topology().to_string();
    assert_eq!(
        line,
        "not closed, 1 part, 6 open edges, 1 non-manifold edge"
    );
}
