//! A mesh's triangles and edges as shadow volumes read them.

use super::{Adjacency, EdgeUse, MeshKind};

/// What is on the GPU, in main memory, for those ways to find silhouettes that work there.
#[derive(Clone, Debug)]
pub(crate) struct MeshData {
    pub positions: Vec<[f32; 3]>,
    /// Three welded vertices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// One record an edge; see [`edge_records`].
    pub edges: Vec<[u32; 4]>,
    /// The uses of all edges; read only where the mesh is general.
    pub edge_uses: Vec<EdgeUse>,
}

/// Four `u32` an edge: two vertices, then for a closed mesh the triangle that runs from the first
/// to the second and the one that runs back; for a general mesh the first of its uses and their
/// number.
pub(crate) fn edge_records(adjacency: &Adjacency) -> Vec<[u32; 4]> {
    let uses = adjacency.edge_uses();
    let record = |edge: &super::Edge| {
        let [a, b] = edge.vertices;
        match adjacency.kind() {
            MeshKind::Closed => {
                let first = edge.first_use as usize;
                [a, b, uses[first].triangle(), uses[first + 1].triangle()]
            }
            MeshKind::General => [a, b, edge.first_use, edge.use_count],
        }
    };
    adjacency.edges().iter().map(record).collect()
}
