//! The semi-axes of any ellipsoid, flat ones included.

use glam::{DMat3, DVec3};

/// How much thinner than its largest extent an ellipsoid may be.
const THINNEST: f64 = 1.0 / 1024.0;
/// What is thinner than this in two directions, as a part of its largest extent, has no area: what rounding to
/// `f32` leaves.
const NO_AREA: f64 = 1.0 / (1 << 20) as f64;
/// Of Jacobi's method for 3 x 3: it doubles its digits with each.
const SWEEPS: usize = 6;

/// The map that makes an ellipsoid the unit sphere, and the ellipsoid's largest semi-axis (or a little more).
/// `None` if it has no area.
pub(super) fn to_unit_sphere(axes: DMat3) -> Option<(DMat3, f64)> {
    let inverse = axes.inverse();
    let (radius, steepest) = (stretch(&axes), stretch(&inverse.transpose()));
    // NaN is no, too.
    if inverse.is_finite() && radius * steepest <= 1.0 / THINNEST {
        return Some((inverse, radius));
    }
    let largest = axes
        .to_cols_array()
        .iter()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    if largest == 0.0 {
        return None;
    }
    let scaled = axes * (1.0 / largest);
    let (squares, directions) = eigen(scaled * scaled.transpose());
    let semi = squares.max(DVec3::ZERO).map(f64::sqrt) * largest;
    let longest = semi.max_element();
    let middle = semi.element_sum() - longest - semi.min_element();
    if middle <= longest * NO_AREA {
        return None;
    }
    let semi = semi.max(DVec3::splat(longest * THINNEST));
    let unit = DMat3::from_diagonal(semi.recip()) * directions.transpose();
    unit.is_finite().then_some((unit, longest))
}

/// The largest stretch of a map, by Gershgorin's circles on its Gram matrix: exact where the columns are
/// orthogonal, never too small.
fn stretch(map: &DMat3) -> f64 {
    let gram = map.transpose() * *map;
    let rows = gram.x_axis.abs() + gram.y_axis.abs() + gram.z_axis.abs();
    rows.max_element().sqrt()
}

/// Eigenvalues of a symmetric matrix, and its eigenvectors as columns, by Jacobi's rotations (1846).
fn eigen(mut matrix: DMat3) -> (DVec3, DMat3) {
    let mut vectors = DMat3::IDENTITY;
    for (p, q) in [(0, 1), (0, 2), (1, 2)]
        .into_iter()
        .cycle()
        .take(3 * SWEEPS)
    {
        let off = matrix.col(q)[p];
        if off == 0.0 {
            continue;
        }
        let theta = (matrix.col(q)[q] - matrix.col(p)[p]) / (2.0 * off);
        let tangent = theta.signum() / (theta.abs() + theta.hypot(1.0));
        let cosine = 1.0 / tangent.hypot(1.0);
        let sine = tangent * cosine;
        let mut rotation = DMat3::IDENTITY;
        rotation.col_mut(p)[p] = cosine;
        rotation.col_mut(q)[q] = cosine;
        rotation.col_mut(q)[p] = sine;
        rotation.col_mut(p)[q] = -sine;
        matrix = rotation.transpose() * matrix * rotation;
        vectors *= rotation;
    }
    let values = DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z);
    (values, vectors)
}

#[cfg(test)]
mod tests {
    use super::{THINNEST, eigen, to_unit_sphere};
    use glam::{DMat3, DQuat, DVec3};

    fn turned(semi: DVec3) -> DMat3 {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1);
        DMat3::from_quat(turn) * DMat3::from_diagonal(semi)
    }

    /// Half the width of what a map makes the unit sphere.
    fn width(unit: DMat3, direction: DVec3) -> f64 {
        (unit.inverse().transpose() * direction).length()
    }

    #[test]
    fn the_surface_comes_to_lie_on_the_unit_sphere_at_any_scale() {
        for scale in [1e-12, 1e-4, 1.0, 1e5, 1e12] {
            let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.7, 1.0, 0.0), DVec3::Z * 0.1);
            for axes in [turned(DVec3::new(1.0, 2.0, 0.01)), sheared] {
                let (unit, radius) = to_unit_sphere(axes * scale).unwrap();
                for direction in [DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, 0.8)] {
                    let length = (unit * (axes * scale * direction)).length();
                    assert!((length - 1.0).abs() < 1e-9, "{length}");
                }
                let widest = (axes * scale).x_axis.length();
                assert!(radius >= widest * (1.0 - 1e-9) && radius < 3.0 * widest.max(2.0 * scale));
            }
        }
    }

    #[test]
    fn what_is_flat_gets_a_thickness_and_what_has_no_area_nothing() {
        for scale in [1e-12, 1.0, 1e12] {
            for thickness in [0.0, 1e-9, 1e-4] {
                let axes = turned(DVec3::new(3.0, thickness, 2.0) * scale);
                let (unit, radius) = to_unit_sphere(axes).unwrap();
                let thin = axes.x_axis.cross(axes.z_axis).normalize();
                assert!((width(unit, thin) / (3.0 * scale * THINNEST) - 1.0).abs() < 1e-6);
                let wide = axes.z_axis.normalize();
                assert!((width(unit, wide) / (2.0 * scale) - 1.0).abs() < 1e-6);
                assert!((radius / (3.0 * scale) - 1.0).abs() < 1e-9);
            }
            for line in [DVec3::X, DVec3::new(1.0, 1e-9, 0.0), DVec3::ZERO] {
                assert_eq!(to_unit_sphere(turned(line * scale)), None);
            }
        }
    }

    #[test]
    fn eigenvectors_make_a_matrix_again() {
        let axes = turned(DVec3::new(1.0, 0.5, 1e-3));
        let matrix = axes * axes.transpose();
        let (values, vectors) = eigen(matrix);
        let again = vectors * DMat3::from_diagonal(values) * vectors.transpose();
        assert!(
            (again - matrix)
                .to_cols_array()
                .iter()
                .all(|e| e.abs() < 1e-15)
        );
    }
}
