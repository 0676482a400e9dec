//! A mesh's triangles and edges as shadow volumes read them.

use std::sync::OnceLock;

use super::blocks::EdgeBlocks;
use super::planes::TrianglePlanes;
use super::{Adjacency, EdgeUse, MeshKind};

/// What shadow volumes need of a mesh, in main memory: for the CPU to find silhouettes, and to be uploaded
/// where a renderer draws them.
#[derive(Clone, Debug)]
pub(crate) struct MeshData {
    /// None, if they lie in a buffer of the host.
    pub positions: Vec<[f32; 3]>,
    /// Three welded vertices a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// One record an edge; see [`edge_records`].
    pub edges: Vec<[u32; 4]>,
    /// The uses of all edges; read only where the mesh is general.
    pub edge_uses: Vec<EdgeUse>,
    /// Made when the CPU first looks for a silhouette.
    planes: OnceLock<TrianglePlanes>,
    blocks: OnceLock<EdgeBlocks>,
}

impl MeshData {
    pub fn new(positions: Vec<[f32; 3]>, edges: Vec<[u32; 4]>, adjacency: &Adjacency) -> Self {
        Self {
            positions,
            triangles: adjacency.triangles().to_vec(),
            edges,
            edge_uses: adjacency.edge_uses().to_vec(),
            planes: OnceLock::new(),
            blocks: OnceLock::new(),
        }
    }

    /// A mesh of its own, and its kind.
    #[cfg(test)]
    pub fn of(positions: &[[f32; 3]], indices: &[u32]) -> (Self, MeshKind) {
        let adjacency = Adjacency::new(positions, indices).expect("a mesh");
        let edges = edge_records(&adjacency);
        let data = Self::new(positions.to_vec(), edges, &adjacency);
        (data, adjacency.kind())
    }

    /// The planes of the triangles.
    pub fn planes(&self) -> &TrianglePlanes {
        self.planes.get_or_init(|| TrianglePlanes::new(self))
    }

    /// The edges in blocks.
    pub fn blocks(&self, kind: MeshKind) -> &EdgeBlocks {
        self.blocks.get_or_init(|| EdgeBlocks::new(self, kind))
    }

    /// Each triangle that uses the edge of a record, and whether it runs through it backwards.
    pub fn for_each_use(&self, edge: &[u32; 4], kind: MeshKind, mut each: impl FnMut(u32, bool)) {
        let &[_, _, first, second] = edge;
        match kind {
            MeshKind::Closed => {
                each(first, false);
                each(second, true);
            }
            MeshKind::General => {
                for edge_use in &self.edge_uses[first as usize..][..second as usize] {
                    each(edge_use.triangle(), edge_use.reversed());
                }
            }
        }
    }
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
