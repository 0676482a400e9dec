//! Adjacency by definition: every triangle against every other, no tables, no sorting.

use shadows::mesh::{Adjacency, Topology};

use crate::shapes::Mesh;

/// One kept triangle.
struct Triangle {
    host: usize,
    /// As the host has them, and welded.
    corners: [u32; 3],
    welded: [u32; 3],
}

/// An edge from the smaller to the larger vertex, and its uses: triangle, and whether it runs the
/// other way.
type Edge = ([u32; 2], Vec<(u32, bool)>);

/// What [`Adjacency`] should say of a mesh.
#[derive(Debug, PartialEq)]
pub struct Naive {
    pub representatives: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
    pub indices: Vec<u32>,
    pub edges: Vec<Edge>,
    pub topology: Topology,
}

fn half_edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

impl Naive {
    /// By the definitions of the crate's documentation.
    pub fn new(mesh: &Mesh) -> Self {
        let representatives: Vec<u32> = (0..mesh.positions.len())
            .map(|i| {
                let same = |j: &usize| mesh.positions[*j] == mesh.positions[i];
                (0..=i).find(same).unwrap() as u32
            })
            .collect();
        let all: Vec<Triangle> = (mesh.indices.chunks_exact(3).enumerate())
            .map(|(host, corners)| {
                let corners = [corners[0], corners[1], corners[2]];
                let welded = corners.map(|corner| representatives[corner as usize]);
                Triangle {
                    host,
                    corners,
                    welded,
                }
            })
            .collect();
        let hosts = all.len();
        let collapsed = |t: &Triangle| half_edges(t.welded).iter().any(|[a, b]| a == b);
        let mut indices: Vec<u32> = all
            .iter()
            .flat_map(|t| {
                let [a, b, c] = t.corners;
                [a, c, b, a, c, b]
            })
            .collect();
        let kept: Vec<Triangle> = all.into_iter().filter(|t| !collapsed(t)).collect();
        for (place, triangle) in kept.iter().enumerate() {
            for (edge, &half_edge) in half_edges(triangle.welded).iter().enumerate() {
                if let Some(vertex) = neighbour(&kept, place, half_edge) {
                    indices[6 * triangle.host + 2 * edge + 1] = vertex;
                }
            }
        }
        let edges = edges(&kept);
        let mut topology = report(&edges, &kept);
        topology.collapsed_triangles = (hosts - kept.len()) as u32;
        topology.zero_area_triangles = count(kept.iter().map(|t| has_no_area(mesh, t)));
        let vertices = 0..mesh.positions.len() as u32;
        topology.unused_vertices = count(vertices.clone().map(|v| !mesh.indices.contains(&v)));
        topology.welded_vertices = count(vertices.map(|v| representatives[v as usize] != v));
        Self {
            representatives,
            triangles: kept.iter().map(|t| t.welded).collect(),
            indices,
            edges,
            topology,
        }
    }

    /// What an adjacency does say of its mesh, in the same terms.
    pub fn of(adjacency: &Adjacency) -> Self {
        let mut edges: Vec<Edge> = (adjacency.edges().iter())
            .map(|edge| {
                let [a, b] = edge.vertices;
                let uses = adjacency.uses(edge).iter();
                let uses = uses.map(|u| (u.triangle(), u.reversed() != (a > b)));
                ([a.min(b), a.max(b)], uses.collect())
            })
            .collect();
        edges.sort();
        Self {
            representatives: adjacency.representatives().to_vec(),
            triangles: adjacency.triangles().to_vec(),
            indices: adjacency.indices().to_vec(),
            edges,
            topology: *adjacency.topology(),
        }
    }
}

/// The host vertex opposite a half-edge: of the first triangle that runs it the other way, or else
/// of the first other one that runs it at all.
fn neighbour(kept: &[Triangle], own: usize, [a, b]: [u32; 2]) -> Option<u32> {
    let third = |wanted: [u32; 2]| {
        kept.iter().enumerate().find_map(|(place, other)| {
            let edge = (place != own).then(|| half_edges(other.welded))?;
            let edge = edge.iter().position(|half_edge| *half_edge == wanted)?;
            Some(other.corners[(edge + 2) % 3])
        })
    };
    third([b, a]).or_else(|| third([a, b]))
}

fn edges(kept: &[Triangle]) -> Vec<Edge> {
    let mut edges: Vec<Edge> = Vec::new();
    for (place, triangle) in (0u32..).zip(kept) {
        for [a, b] in half_edges(triangle.welded) {
            let key = [a.min(b), a.max(b)];
            let found = edges.iter().position(|(vertices, _)| *vertices == key);
            let found = found.unwrap_or_else(|| {
                edges.push((key, Vec::new()));
                edges.len() - 1
            });
            edges[found].1.push((place, a > b));
        }
    }
    edges.sort();
    edges
}

fn report(edges: &[Edge], kept: &[Triangle]) -> Topology {
    let mut topology = Topology::default();
    topology.open_edges = count(edges.iter().map(|(_, uses)| uses.len() == 1));
    topology.non_manifold_edges = count(edges.iter().map(|(_, uses)| uses.len() > 2));
    topology.inconsistent_edges =
        count((edges.iter()).map(|(_, uses)| uses.len() == 2 && uses[0].1 == uses[1].1));
    topology.closed = (edges.iter())
        .all(|(_, uses)| matches!(uses[..], [(_, first), (_, second)] if first != second));
    let sorted = |t: &Triangle| {
        let mut vertices = t.welded;
        vertices.sort();
        vertices
    };
    topology.duplicate_triangles = count(
        (0..kept.len())
            .map(|place| (0..place).any(|earlier| sorted(&kept[earlier]) == sorted(&kept[place]))),
    );
    topology.parts = parts(kept);
    topology
}

/// Spreads labels over shared vertices until nothing changes.
fn parts(kept: &[Triangle]) -> u32 {
    let mut labels: Vec<usize> = (0..kept.len()).collect();
    loop {
        let before = labels.clone();
        for i in 0..kept.len() {
            for j in 0..kept.len() {
                if kept[i].welded.iter().any(|v| kept[j].welded.contains(v)) {
                    labels[i] = labels[i].min(labels[j]);
                }
            }
        }
        if labels == before {
            return count((0..kept.len()).map(|i| labels[i] == i));
        }
    }
}

/// Exact where the coordinates are small integers or have few digits.
fn has_no_area(mesh: &Mesh, triangle: &Triangle) -> bool {
    let [a, b, c] = triangle
        .corners
        .map(|corner| mesh.positions[corner as usize].map(f64::from));
    let d = |axis: usize| (b[axis] - a[axis], c[axis] - a[axis]);
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(x, y)| d(x).0 * d(y).1 == d(y).0 * d(x).1)
}

fn count(is: impl Iterator<Item = bool>) -> u32 {
    is.map(u32::from).sum()
}
