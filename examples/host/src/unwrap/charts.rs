//! Which triangles are one chart.

use std::collections::HashMap;

use shadows::glam::DVec3;

/// Cosines of the angles within which a chart's triangles face: its texels are longer by 1 over that at most. A
/// chart that folds back over itself is divided by the next one; after the last each triangle is a chart.
pub const COSINES: [f64; 4] = [0.82, 0.97, 0.999, 0.999_999];

/// Of each triangle with an area its chart and the normal that the chart is projected along.
pub type Charts = Vec<Option<(usize, DVec3)>>;

/// Triangles at each edge of each triangle, by their corners' bits.
pub fn neighbours(positions: &[[f32; 3]]) -> Vec<Vec<usize>> {
    // -0 is 0.
    let key = |position: [f32; 3]| position.map(|part| (part + 0.0).to_bits());
    let mut edges: HashMap<[[u32; 3]; 2], Vec<usize>> = HashMap::new();
    for (triangle, corners) in positions.chunks_exact(3).enumerate() {
        for k in 0..3 {
            let mut edge = [key(corners[k]), key(corners[(k + 1) % 3])];
            edge.sort_unstable();
            edges.entry(edge).or_default().push(triangle);
        }
    }
    let mut neighbours = vec![Vec::new(); positions.len() / 3];
    for triangles in edges.values() {
        for &triangle in triangles {
            neighbours[triangle].extend(triangles.iter().filter(|other| **other != triangle));
        }
    }
    // The map has no order, and charts must not depend on it.
    neighbours.iter_mut().for_each(|near| near.sort_unstable());
    neighbours
}

/// Charts grown over edges, each from the first triangle that has none: of triangles that face within the angle of their
/// common level.
pub fn grown(normals: &[DVec3], neighbours: &[Vec<usize>], levels: &[usize]) -> Charts {
    let mut charts: Charts = vec![None; normals.len()];
    let mut count = 0;
    for first in 0..normals.len() {
        let (normal, level) = (normals[first], levels[first]);
        if normal == DVec3::ZERO || charts[first].is_some() {
            continue;
        }
        charts[first] = Some((count, normal));
        let mut edge = vec![first];
        while let (Some(triangle), Some(&cosine)) = (edge.pop(), COSINES.get(level)) {
            for &next in &neighbours[triangle] {
                let joins = charts[next].is_none() && levels[next] == level;
                if joins && normals[next].dot(normal) > cosine {
                    charts[next] = Some((count, normal));
                    edge.push(next);
                }
            }
        }
        count += 1;
    }
    charts
}
