//! Adjacency (interface; being filled in).
use crate::error::MeshError;

/// Which rule casts an exact shadow from a mesh at least cost; decided once, when it is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeshKind {
    /// Every edge has exactly two triangles, which run through it in opposite directions.
    Closed,
    /// Anything else.
    General,
}

/// An edge between two welded vertices, with all its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The two welded vertices (representatives), in the direction of the first use.
    pub vertices: [u32; 2],
    /// First of this edge's uses in [`Adjacency::edge_uses`].
    pub first_use: u32,
    /// Number of uses.
    pub use_count: u32,
}

/// One triangle's use of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct EdgeUse(u32);

impl EdgeUse {
    /// The triangle, a place in [`Adjacency::triangles`].
    pub fn triangle(self) -> u32 {
        self.0 >> 1
    }
    /// Whether the triangle runs through the edge from `vertices[1]` to `vertices[0]`.
    pub fn reversed(self) -> bool {
        self.0 & 1 == 1
    }
}

/// What a mesh's connectivity is like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Topology {}

/// Welded triangles and their edges.
#[derive(Clone, Debug)]
pub struct Adjacency {
    vertex_count: u32,
    triangles: Vec<[u32; 3]>,
    edges: Vec<Edge>,
    edge_uses: Vec<EdgeUse>,
    kind: MeshKind,
}

impl Adjacency {
    /// Builds.
    pub fn new<P: Copy + Into<[f32; 3]>>(
        _positions: &[P],
        _indices: &[u32],
    ) -> Result<Self, MeshError> {
        Err(MeshError::Tolerance(0.0))
    }
    /// Number of vertices of the host's mesh.
    pub fn vertex_count(&self) -> u32 {
        self.vertex_count
    }
    /// The welded triangles, without those that collapsed; corner order as the host's.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }
    /// The edges.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }
    /// The uses of all edges, edge after edge.
    pub fn edge_uses(&self) -> &[EdgeUse] {
        &self.edge_uses
    }
    /// Closed or general.
    pub fn kind(&self) -> MeshKind {
        self.kind
    }
}
