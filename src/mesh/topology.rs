//! The connectivity of a mesh.

use std::fmt;

use super::MeshKind;

/// Properties of a mesh, found when its adjacency was built. All counts are after welding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Topology {
    /// Whether every edge has exactly two triangles, which traverse it in opposite directions, so that the
    /// three edge counts below are 0. True for an empty mesh.
    ///
    /// A vertex shared by closed surfaces (a bow tie) does not matter to shadows and is allowed.
    pub closed: bool,
    /// Edges with one triangle.
    pub open_edges: u32,
    /// Edges with three or more triangles.
    pub non_manifold_edges: u32,
    /// Edges with two triangles that traverse it in the same direction: their windings disagree.
    pub inconsistent_edges: u32,
    /// Triangles with two corners at one vertex after welding; they are left out.
    pub collapsed_triangles: u32,
    /// Triangles whose three vertices differ but lie exactly on one line; they are kept, since
    /// their edges connect others (at a T-junction, for example), and cast nothing themselves.
    pub zero_area_triangles: u32,
    /// Triangles with the same three vertices as an earlier one, in any order; they are kept.
    pub duplicate_triangles: u32,
    /// Vertices that no index refers to.
    pub unused_vertices: u32,
    /// Vertices that welding replaced by an earlier one.
    pub welded_vertices: u32,
    /// Connected parts, which share no welded vertex with each other. Two boxes that touch in a corner vertex
    /// are one part; unused vertices and collapsed triangles do not count.
    pub parts: u32,
}

impl Default for Topology {
    /// That of an empty mesh.
    fn default() -> Self {
        Self {
            closed: true,
            open_edges: 0,
            non_manifold_edges: 0,
            inconsistent_edges: 0,
            collapsed_triangles: 0,
            zero_area_triangles: 0,
            duplicate_triangles: 0,
            unused_vertices: 0,
            welded_vertices: 0,
            parts: 0,
        }
    }
}

impl Topology {
    /// The method that casts an exact shadow volume from such a mesh at the lowest cost.
    pub fn kind(&self) -> MeshKind {
        if self.closed {
            MeshKind::Closed
        } else {
            MeshKind::General
        }
    }
}

impl fmt::Display for Topology {
    /// One line: `closed, 1 part`, followed by whatever is not zero.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = if self.closed { "closed" } else { "not closed" };
        let plural = if self.parts == 1 { "" } else { "s" };
        write!(f, "{state}, {} part{plural}", self.parts)?;
        for (count, one, many) in [
            (self.open_edges, "open edge", "open edges"),
            (
                self.non_manifold_edges,
                "non-manifold edge",
                "non-manifold edges",
            ),
            (
                self.inconsistent_edges,
                "inconsistent edge",
                "inconsistent edges",
            ),
            (
                self.collapsed_triangles,
                "collapsed triangle",
                "collapsed triangles",
            ),
            (
                self.zero_area_triangles,
                "zero-area triangle",
                "zero-area triangles",
            ),
            (
                self.duplicate_triangles,
                "duplicate triangle",
                "duplicate triangles",
            ),
            (self.welded_vertices, "welded vertex", "welded vertices"),
            (self.unused_vertices, "unused vertex", "unused vertices"),
        ] {
            match count {
                0 => {}
                1 => write!(f, ", 1 {one}")?,
                _ => write!(f, ", {count} {many}")?,
            }
        }
        Ok(())
    }
}
