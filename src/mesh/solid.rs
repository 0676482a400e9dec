//! Whether a closed mesh is the boundary of a solid, wound counter-clockwise seen from outside.

use glam::{DVec3, Vec3};

use super::parts::Parts;
use super::{Adjacency, MeshKind};

/// Whether every connected surface of a closed mesh encloses a positive volume, so that whatever
/// is nearest along a ray from outside faces the ray.
///
/// Where a surface passes through itself so that part of it is inside out, that part is not noticed
/// here. Surfaces of (almost) no volume and cavities make the answer `false`.
pub(super) fn is_solid(positions: &[[f32; 3]], adjacency: &Adjacency) -> bool {
    if adjacency.kind() != MeshKind::Closed {
        return false;
    }
    let triangles = adjacency.triangles();
    let mut surfaces = Parts::new(triangles.len());
    for edge in adjacency.edges() {
        if let [one, other] = adjacency.uses(edge) {
            let root = surfaces.find(one.triangle());
            surfaces.join(root, other.triangle());
        }
    }
    // Volumes as sums of tetrahedra from each surface's first vertex, with the sum of their sizes:
    // rounding of each is some parts in 1e16 of the latter.
    let mut volumes = vec![(0.0_f64, 0.0_f64); triangles.len()];
    for (index, triangle) in triangles.iter().enumerate() {
        let root = surfaces.find(index as u32) as usize;
        let place = |vertex: u32| -> DVec3 { Vec3::from(positions[vertex as usize]).as_dvec3() };
        let origin = place(triangles[root][0]);
        let [a, b, c] = triangle.map(|vertex| place(vertex) - origin);
        let volume = a.dot(b.cross(c));
        volumes[root].0 += volume;
        volumes[root].1 += volume.abs();
    }
    (0..triangles.len())
        .filter(|&index| surfaces.find(index as u32) as usize == index)
        .all(|root| volumes[root].0 > 1e-9 * volumes[root].1)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    const OUTWARD: [u32; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

    fn solid(positions: &[[f32; 3]], indices: &[u32]) -> bool {
        is_solid(positions, &Adjacency::new(positions, indices).unwrap())
    }

    fn reversed(indices: &[u32]) -> Vec<u32> {
        indices.iter().rev().copied().collect()
    }

    #[test]
    fn a_tetrahedron_is_solid_unless_inside_out_or_open() {
        assert!(solid(&CORNERS, &OUTWARD));
        assert!(!solid(&CORNERS, &reversed(&OUTWARD)));
        assert!(!solid(&CORNERS, &OUTWARD[..9]));
    }

    #[test]
    fn one_surface_inside_out_spoils_the_mesh() {
        let far = CORNERS.map(|[x, y, z]| [x + 1e4, y * 9.0, z * 9.0]);
        let positions: Vec<[f32; 3]> = CORNERS.into_iter().chain(far).collect();
        let second = OUTWARD.map(|index| index + 4);
        let both: Vec<u32> = OUTWARD.into_iter().chain(second).collect();
        assert!(solid(&positions, &both));
        let mixed: Vec<u32> = reversed(&OUTWARD).into_iter().chain(second).collect();
        assert!(!solid(&positions, &mixed), "the large one does not hide it");
    }

    #[test]
    fn a_card_with_two_sides_has_no_inside() {
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(!solid(&flat, &[0, 1, 2, 0, 2, 1]));
    }
}
