//! Checks a host's own list of six indices a triangle.

use super::edges::Edges;
use super::triangles::Triangles;
use crate::error::MeshError;

/// Checks that each opposite vertex forms a triangle of the mesh with its edge.
///
/// # Errors
/// [`MeshError::NotAdjacent`] for the first triangle and edge of which this is not true.
pub(super) fn check(
    six: &[u32],
    representatives: &[u32],
    triangles: &Triangles,
    edges: &Edges,
) -> Result<(), MeshError> {
    let mut thirds = Vec::new();
    let mut culprit: Option<(u32, u32, u32)> = None;
    for edge in &edges.edges {
        let first = edge.first_use as usize;
        let sides = edges.uses[first..first + edge.use_count as usize]
            .iter()
            .map(|edge_use| {
                let from = edge.vertices[usize::from(edge_use.reversed())];
                let corners = triangles.corners[edge_use.triangle() as usize];
                let corner = if corners[0] == from {
                    0
                } else if corners[1] == from {
                    1
                } else {
                    2
                };
                (*edge_use, corner, corners[(corner + 2) % 3])
            });
        thirds.clear();
        thirds.extend(sides.clone().map(|(_, _, third)| third));
        thirds.sort_unstable();
        for (edge_use, corner, _) in sides {
            let host = triangles.host(edge_use.triangle());
            let vertex = six[host as usize * 6 + 2 * corner + 1];
            let third = representatives[vertex as usize];
            if thirds.binary_search(&third).is_err() {
                let found = (host, corner as u32, vertex);
                culprit = Some(culprit.map_or(found, |earlier| earlier.min(found)));
            }
        }
    }
    culprit.map_or(Ok(()), |(triangle, edge, vertex)| {
        Err(MeshError::NotAdjacent {
            triangle,
            edge,
            vertex,
        })
    })
}
