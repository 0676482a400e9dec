//! Adjacency: welded triangles, their edges, and six indices per triangle.

use super::edges::{self, Edges};
use super::tolerance::weld_near;
use super::triangles::Triangles;
use super::weld::weld;
use super::{Topology, input, raw};
use crate::error::MeshError;

/// Which method casts an exact shadow volume from a mesh at the lowest cost; decided once, when it is built.
/// Exhaustive: a mesh that is not closed is general.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeshKind {
    /// Every edge has exactly two triangles, which traverse it in opposite directions.
    Closed,
    /// Anything else.
    General,
}

/// An edge between two welded vertices, with all its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The two welded vertices (representatives), in the direction of its first use.
    pub vertices: [u32; 2],
    /// Index of its first use in [`Adjacency::edge_uses`].
    pub first_use: u32,
    /// Number of uses.
    pub use_count: u32,
}

/// One triangle's use of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct EdgeUse(u32);

impl EdgeUse {
    pub(super) fn new(triangle: u32, reversed: bool) -> Self {
        Self(triangle << 1 | u32::from(reversed))
    }

    /// The triangle, as an index into [`Adjacency::triangles`].
    pub fn triangle(self) -> u32 {
        self.0 >> 1
    }

    /// Whether the triangle traverses the edge from `vertices[1]` to `vertices[0]`.
    pub fn reversed(self) -> bool {
        self.0 & 1 == 1
    }
}

/// Welded triangles and their edges, and the host's triangles with their neighbours.
///
/// Vertices at the same position are treated as one vertex, regardless of their normals and texture
/// coordinates; the lowest index among them represents them all. A triangle with two corners at one vertex
/// has collapsed: it stays in [`indices`](Self::indices), which follow the host's triangles, but not in
/// [`triangles`](Self::triangles) or the edges.
///
/// ```
/// use shadows::mesh::{Adjacency, MeshKind};
///
/// let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let tetrahedron = Adjacency::new(&corners, &[0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3])?;
/// assert_eq!(tetrahedron.kind(), MeshKind::Closed);
/// assert_eq!(tetrahedron.edges().len(), 6);
/// assert_eq!(tetrahedron.indices()[..6], [0, 3, 2, 3, 1, 3]);
/// # Ok::<(), shadows::error::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Adjacency {
    vertex_count: u32,
    representatives: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    indices: Vec<u32>,
    edges: Vec<Edge>,
    edge_uses: Vec<EdgeUse>,
    topology: Topology,
}

impl Adjacency {
    /// Builds the adjacency of a triangle list with three indices per triangle.
    ///
    /// Vertices are welded where all three coordinates are equal (-0 equals +0). Time and memory are linear
    /// in vertices and triangles, except for `n log n` in the number of triangles around one vertex.
    ///
    /// # Errors
    /// [`MeshError`] if the number of indices is not a multiple of three, an index is out of range, or a
    /// coordinate is not finite, or if there are more than 2^32 - 1 vertices or edge uses (three per
    /// triangle).
    pub fn new<P: Copy + Into<[f32; 3]>>(
        positions: &[P],
        indices: &[u32],
    ) -> Result<Self, MeshError> {
        Self::with_tolerance(positions, indices, 0.0)
    }

    /// Like [`new`](Self::new), but also welds vertices that are close to each other.
    ///
    /// `tolerance` is a fraction of the mesh's size, which is the largest side of its bounds: 0 <=
    /// `tolerance` < 1. In the order of their indices, each vertex joins the lowest-indexed representative
    /// within that (Euclidean) distance or, if there is none, becomes one. No vertex therefore moves by more
    /// than the tolerance, chains of close vertices do not collapse, and representatives stay farther apart
    /// than the tolerance. Two vertices within the tolerance may still end up with different representatives.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), and [`MeshError::Tolerance`].
    pub fn with_tolerance<P: Copy + Into<[f32; 3]>>(
        positions: &[P],
        indices: &[u32],
        tolerance: f32,
    ) -> Result<Self, MeshError> {
        input::check_tolerance(tolerance)?;
        let vertices = input::check_counts(positions.len(), indices.len(), 3)?;
        input::check_indices(indices, vertices)?;
        let positions = input::pack(positions)?;
        let mut representatives = weld(&positions);
        if tolerance > 0.0 {
            weld_near(&positions, &mut representatives, tolerance);
        }
        let (corners, _) = indices.as_chunks::<3>();
        let mut six = without_neighbours(corners.iter().copied());
        let connected = Connected::new(&positions, &representatives, &mut six);
        Ok(connected.into_adjacency(vertices, representatives, six))
    }

    /// Takes the host's own adjacency: six indices per triangle in the order of [`indices`](Self::indices),
    /// which then returns this very list.
    ///
    /// Each opposite vertex must form a triangle of the mesh with its edge, after welding as in
    /// [`new`](Self::new); if there are several such triangles, any of them will do. The triangle's own third
    /// corner is allowed as well, and means that there is no neighbour. The opposite vertices of a triangle
    /// that collapsed during welding are ignored.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), and [`MeshError::NotAdjacent`].
    pub fn from_raw<P: Copy + Into<[f32; 3]>>(
        positions: &[P],
        indices: &[u32],
    ) -> Result<Self, MeshError> {
        let vertices = input::check_counts(positions.len(), indices.len(), 6)?;
        input::check_indices(indices, vertices)?;
        let positions = input::pack(positions)?;
        let representatives = weld(&positions);
        let (sextuples, _) = indices.as_chunks::<6>();
        let corners = sextuples.iter().map(|&[a, _, b, _, c, _]| [a, b, c]);
        let mut six = without_neighbours(corners);
        let connected = Connected::new(&positions, &representatives, &mut six);
        raw::check(
            indices,
            &representatives,
            &connected.triangles,
            &connected.edges,
        )?;
        six.copy_from_slice(indices);
        Ok(connected.into_adjacency(vertices, representatives, six))
    }

    /// Number of vertices of the host's mesh.
    pub fn vertex_count(&self) -> u32 {
        self.vertex_count
    }

    /// For each vertex of the host's mesh, the vertex that represents it: the lowest-indexed of those welded
    /// together, or itself if it was not welded.
    pub fn representatives(&self) -> &[u32] {
        &self.representatives
    }

    /// The welded triangles, without those that collapsed, with triangles and corners in the host's order.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Six indices for each of the host's triangles, in the order of OpenGL's
    /// `GL_TRIANGLES_ADJACENCY`: v0, opposite of v0 v1, v1, opposite of v1 v2, v2, opposite of
    /// v2 v0.
    ///
    /// All are the host's own indices: the corners as passed, the opposite vertices as used by the neighbour.
    ///
    /// If an edge has several other triangles, the neighbour is the first in the host's order that traverses
    /// the edge in the opposite direction, or the first of all if there is none.
    ///
    /// If there is no neighbour, the opposite vertex is the triangle's own third corner: the triangle is
    /// folded back onto itself, like a two-sided sheet. A silhouette test then sees a neighbour of exactly
    /// opposite facing and draws the open edge, without a special case. (Repeating an end of the edge, as
    /// meshoptimizer does, gives a neighbour without area, whose facing is rounding noise.) A triangle that
    /// collapsed has no neighbours.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// The edges of the welded triangles, sorted by their smaller vertex, then by their larger one.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The uses of all edges, edge by edge, and for each edge in the order of the triangles.
    ///
    /// The first use of an edge is never reversed. If the mesh is [`MeshKind::Closed`], each edge has two
    /// uses and the second is reversed.
    pub fn edge_uses(&self) -> &[EdgeUse] {
        &self.edge_uses
    }

    /// The uses of one of this adjacency's edges (possibly none for an edge from elsewhere).
    pub fn uses(&self, edge: &Edge) -> &[EdgeUse] {
        let first = edge.first_use as usize;
        let end = first.saturating_add(edge.use_count as usize);
        self.edge_uses.get(first..end).unwrap_or_default()
    }

    /// The properties found in the mesh.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Closed or general.
    pub fn kind(&self) -> MeshKind {
        self.topology.kind()
    }
}

/// The list of six with no neighbours yet.
fn without_neighbours(corners: impl Iterator<Item = [u32; 3]>) -> Vec<u32> {
    let sextuples: Vec<[u32; 6]> = corners.map(|[a, b, c]| [a, c, b, a, c, b]).collect();
    sextuples.into_flattened()
}

/// What is built from welded vertices.
struct Connected {
    triangles: Triangles,
    edges: Edges,
    topology: Topology,
}

impl Connected {
    /// Connects the triangles and fills their neighbours into the list of six.
    fn new(positions: &[[f32; 3]], representatives: &[u32], six: &mut [u32]) -> Self {
        let numbered = representatives.iter().zip(0u32..);
        let mut topology = Topology {
            welded_vertices: numbered
                .map(|(own, vertex)| u32::from(*own != vertex))
                .sum(),
            ..Topology::default()
        };
        let triangles = Triangles::welded(positions, six, representatives, &mut topology);
        let edges = edges::connect(&triangles, positions.len(), six, &mut topology);
        Self {
            triangles,
            edges,
            topology,
        }
    }

    fn into_adjacency(
        self,
        vertex_count: u32,
        representatives: Vec<u32>,
        indices: Vec<u32>,
    ) -> Adjacency {
        Adjacency {
            vertex_count,
            representatives,
            triangles: self.triangles.corners,
            indices,
            edges: self.edges.edges,
            edge_uses: self.edges.uses,
            topology: self.topology,
        }
    }
}
