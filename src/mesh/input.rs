//! What is checked of a host's mesh before any work is done with it.

use crate::error::MeshError;

/// Most triangles a mesh can have: three uses of edges each, all counted in 32 bits.
pub(super) const MAX_TRIANGLES: usize = (u32::MAX / 3) as usize;

/// Most vertices a mesh can have: `u32::MAX` itself stands for "none".
pub(super) const MAX_VERTICES: usize = u32::MAX as usize;

/// Checks the lengths of both lists and returns the number of vertices.
pub(super) fn check_counts(
    vertices: usize,
    indices: usize,
    per_triangle: usize,
) -> Result<u32, MeshError> {
    if !indices.is_multiple_of(per_triangle) {
        return Err(MeshError::IndexCount {
            count: indices,
            per_triangle,
        });
    }
    let triangles = indices / per_triangle;
    if triangles > MAX_TRIANGLES {
        return Err(MeshError::TooLarge {
            what: "triangles",
            count: triangles,
            limit: MAX_TRIANGLES,
        });
    }
    u32::try_from(vertices).map_err(|_| MeshError::TooLarge {
        what: "vertices",
        count: vertices,
        limit: MAX_VERTICES,
    })
}

/// Checks that every index names a vertex.
pub(super) fn check_indices(indices: &[u32], vertices: u32) -> Result<(), MeshError> {
    // The maximum vectorizes; the search for the culprit is only for the error message.
    let largest = indices.iter().copied().max();
    if largest.is_none_or(|largest| largest < vertices) {
        return Ok(());
    }
    let culprit = (0..).zip(indices).find(|&(_, &index)| index >= vertices);
    culprit.map_or(Ok(()), |(place, &index)| {
        Err(MeshError::IndexOutOfRange {
            place,
            index,
            vertices,
        })
    })
}

/// Checks a weld tolerance: a fraction of the mesh's size in `0 <= t < 1`.
pub(super) fn check_tolerance(tolerance: f32) -> Result<(), MeshError> {
    if (0.0..1.0).contains(&tolerance) {
        Ok(())
    } else {
        Err(MeshError::Tolerance(tolerance))
    }
}

/// The positions side by side, every -0 turned into +0 so that equal coordinates have equal bits.
pub(super) fn pack<P: Copy + Into<[f32; 3]>>(positions: &[P]) -> Result<Vec<[f32; 3]>, MeshError> {
    let mut finite = true;
    let packed: Vec<[f32; 3]> = positions
        .iter()
        .map(|&position| {
            let [x, y, z] = position.into();
            finite &= x.is_finite() & y.is_finite() & z.is_finite();
            [x + 0.0, y + 0.0, z + 0.0]
        })
        .collect();
    if finite {
        return Ok(packed);
    }
    for (&position, vertex) in packed.iter().zip(0u32..) {
        if position.iter().any(|coordinate| !coordinate.is_finite()) {
            return Err(MeshError::Position { vertex, position });
        }
    }
    Ok(packed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_just_below_the_limits_passes_and_one_above_does_not() {
        assert_eq!(
            check_counts(MAX_VERTICES, 3 * MAX_TRIANGLES, 3),
            Ok(u32::MAX)
        );
        let count = MAX_TRIANGLES + 1;
        let too_large = MeshError::TooLarge {
            what: "triangles",
            count,
            limit: MAX_TRIANGLES,
        };
        assert_eq!(check_counts(0, 3 * count, 3), Err(too_large.clone()));
        assert_eq!(check_counts(0, 6 * count, 6), Err(too_large));
    }
}
