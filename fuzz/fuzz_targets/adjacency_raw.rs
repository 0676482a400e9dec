//! A host's own six indices a triangle: any, and those that the library itself found, changed.
#![no_main]

use libfuzzer_sys::fuzz_target;
use shadows::mesh::Adjacency;
use shadows_fuzz::mesh::{Mesh, check};

fuzz_target!(|input: (Mesh, Vec<(u8, u8)>)| {
    let (mesh, changes) = input;
    let positions = mesh.positions();
    if let Ok(adjacency) = Adjacency::from_raw(&positions, &mesh.indices()) {
        let corners: Vec<u32> = mesh.indices().iter().copied().step_by(2).collect();
        check(&adjacency, &corners);
    }
    let Ok(built) = mesh.adjacency() else { return };
    let raw = Adjacency::from_raw(&positions, built.indices()).expect("its own list");
    assert_eq!(raw.edges(), built.edges());
    assert_eq!(raw.edge_uses(), built.edge_uses());
    assert_eq!(raw.topology(), built.topology());

    // Other opposite vertices: refused, or the same edges all the same.
    let mut six = built.indices().to_vec();
    if six.is_empty() {
        return;
    }
    for (place, vertex) in changes {
        let opposite = (usize::from(place) * 2 + 1) % six.len();
        six[opposite] = u32::from(vertex) % built.vertex_count();
    }
    if let Ok(changed) = Adjacency::from_raw(&positions, &six) {
        assert_eq!(changed.indices(), six);
        assert_eq!(changed.edges(), built.edges());
    }
});
