//! Every error, and that what is put right is then taken.

use shadows::error::MeshError;
use shadows::mesh::Adjacency;

use crate::shapes::{Mesh, cube, cube_of_24, fins};

fn new(mesh: &Mesh) -> Result<Adjacency, MeshError> {
    Adjacency::new(&mesh.positions, &mesh.indices)
}

#[test]
fn indices_that_are_no_whole_triangles_are_refused() {
    let mut mesh = cube();
    let last = mesh.indices.pop().unwrap();
    let (count, per_triangle) = (35, 3);
    let error = MeshError::IndexCount {
        count,
        per_triangle,
    };
    assert_eq!(new(&mesh).unwrap_err(), error);
    let raw = Adjacency::from_raw(&mesh.positions, &mesh.indices[..33]);
    let (count, per_triangle) = (33, 6);
    let error = MeshError::IndexCount {
        count,
        per_triangle,
    };
    assert_eq!(raw.unwrap_err(), error);
    mesh.indices.push(last);
    assert!(new(&mesh).is_ok());
}

#[test]
fn an_index_past_the_last_vertex_is_named() {
    let mut mesh = cube();
    mesh.indices[17] = 8;
    let error = MeshError::IndexOutOfRange {
        place: 17,
        index: 8,
        vertices: 8,
    };
    assert_eq!(new(&mesh).unwrap_err(), error);
    mesh.positions.push([0.5; 3]);
    assert!(new(&mesh).is_ok());
    let raw = Adjacency::from_raw(&mesh.positions[..1], &[0, 0, 0, 1, 0, 0]);
    assert!(matches!(
        raw,
        Err(MeshError::IndexOutOfRange { place: 3, .. })
    ));
}

#[test]
fn a_coordinate_that_is_not_finite_is_named() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let mut mesh = cube();
            mesh.positions[5][axis] = bad;
            let result = new(&mesh);
            assert!(matches!(result, Err(MeshError::Position { vertex: 5, .. })));
            mesh.positions[5][axis] = f32::MAX;
            assert!(new(&mesh).is_ok());
        }
    }
}

#[test]
fn a_tolerance_out_of_range_is_refused() {
    let mesh = cube();
    let with = |tolerance| Adjacency::with_tolerance(&mesh.positions, &mesh.indices, tolerance);
    for bad in [f32::NAN, -1e-6, 1.0, f32::INFINITY] {
        assert!(matches!(with(bad), Err(MeshError::Tolerance(_))), "{bad}");
    }
    for good in [0.0, f32::from_bits(1), 1.0 - f32::EPSILON] {
        assert!(with(good).is_ok(), "{good}");
    }
}

/// A position that takes no memory, so that a list of more than 2^32 of them can be made.
#[cfg(target_pointer_width = "64")]
#[derive(Clone, Copy)]
struct Nowhere;

#[cfg(target_pointer_width = "64")]
impl From<Nowhere> for [f32; 3] {
    fn from(_: Nowhere) -> Self {
        [0.0; 3]
    }
}

#[test]
#[cfg(target_pointer_width = "64")]
fn more_vertices_than_32_bits_count_are_refused() {
    let positions = vec![Nowhere; 1 << 32];
    let error = MeshError::TooLarge {
        what: "vertices",
        count: 1 << 32,
        limit: u32::MAX as usize,
    };
    let refused = Adjacency::new(&positions, &[0, 1, 2]);
    assert_eq!(refused.unwrap_err(), error);
    assert!(Adjacency::new(&positions[..100], &[0, 1, 2]).is_ok());
}

#[test]
fn a_host_list_that_is_right_is_kept() {
    for mesh in [cube(), cube_of_24(), fins(5, true)] {
        let built = new(&mesh).unwrap();
        let raw = Adjacency::from_raw(&mesh.positions, built.indices()).unwrap();
        assert_eq!(raw.indices(), built.indices());
        assert_eq!(raw.edges(), built.edges());
        assert_eq!(raw.topology(), built.topology());
    }
    // Of several neighbours, or none, the host may choose another than we do.
    let mesh = fins(5, true);
    let mut six = new(&mesh).unwrap().indices().to_vec();
    for choice in [2, 4, 5, 6] {
        assert_ne!(six[1], choice);
        six[1] = choice;
        let raw = Adjacency::from_raw(&mesh.positions, &six).unwrap();
        assert_eq!(raw.indices(), six);
    }
}

#[test]
fn a_host_list_that_is_wrong_anywhere_is_refused() {
    let mesh = cube_of_24();
    let adjacency = new(&mesh).unwrap();
    let representatives = adjacency.representatives();
    let six = adjacency.indices();
    for place in (1..six.len()).step_by(2) {
        let (triangle, edge) = (place / 6, place % 6 / 2);
        let own_third = six[6 * triangle + (2 * edge + 4) % 6];
        for vertex in 0..24u32 {
            let mut raw = six.to_vec();
            raw[place] = vertex;
            let welded = |v: u32| representatives[v as usize];
            let right = [six[place], own_third].map(welded);
            let result = Adjacency::from_raw(&mesh.positions, &raw);
            if right.contains(&welded(vertex)) {
                assert_eq!(result.unwrap().indices(), raw);
            } else {
                let error = MeshError::NotAdjacent {
                    triangle: triangle as u32,
                    edge: edge as u32,
                    vertex,
                };
                assert_eq!(result.unwrap_err(), error);
            }
        }
    }
}

#[test]
fn the_first_of_several_wrong_entries_is_named() {
    let mesh = cube();
    let mut six = new(&mesh).unwrap().indices().to_vec();
    for sextuple in six[12..].chunks_exact_mut(6) {
        (sextuple[3], sextuple[5]) = (sextuple[2], sextuple[4]);
    }
    let error = Adjacency::from_raw(&mesh.positions, &six).unwrap_err();
    let vertex = six[12 + 3];
    let expected = MeshError::NotAdjacent {
        triangle: 2,
        edge: 1,
        vertex,
    };
    assert_eq!(error, expected);
}
