//! The ellipsoid that stands in for a caster.

use glam::{DMat3, DVec3, Vec3};

use crate::mesh::{Bounds, Caster};

/// How much wider an ellipse of a rectangle's area is than the rectangle: 2 / sqrt(pi).
const SAME_AREA: f64 = std::f64::consts::FRAC_2_SQRT_PI;
/// How much wider an ellipsoid of a box's volume is than the box: (6 / pi)^(1/3).
const SAME_VOLUME: f64 = 1.240_700_981_798_799_8;

/// An ellipsoid that blocks light in place of a caster, in world space.
///
/// ```
/// use shadows::{Blob, glam::Vec3};
/// let ball = Blob::sphere(Vec3::new(0.0, 1.0, 0.0), 0.5);
/// // A person of 1.8 m, a little more than half as dark as a solid thing.
/// let person = Blob {
///     axes: [Vec3::X * 0.25, Vec3::Y * 0.9, Vec3::Z * 0.2],
///     opacity: 0.6,
///     ..Blob::sphere(Vec3::new(2.0, 0.9, 0.0), 1.0)
/// };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob {
    /// Its centre.
    pub centre: Vec3,
    /// The columns of the matrix that maps the unit sphere to the ellipsoid: its semi-axes, if they are
    /// orthogonal, which they need not be.
    ///
    /// An ellipsoid thinner than 1/1024 of its largest extent is treated as having that thickness, so that
    /// flat ones cast a shadow. Degenerate ones without an area (a line, a point) cast none.
    pub axes: [Vec3; 3],
    /// The fraction of light that it blocks, from 0 (none) to 1 (all).
    pub opacity: f32,
}

impl Blob {
    /// A sphere that blocks all light.
    pub fn sphere(centre: Vec3, radius: f32) -> Self {
        Self {
            centre,
            axes: [Vec3::X * radius, Vec3::Y * radius, Vec3::Z * radius],
            opacity: 1.0,
        }
    }

    /// The ellipsoid for a caster, from its mesh's bounds and its transform. For an instanced mesh
    /// ([`HostInstances`](crate::HostInstances)) it is one around all instances.
    ///
    /// Its centre is that of the bounds. If the mesh stays away from the corners of its bounds, as an ellipsoid
    /// does, it touches the sides of the bounds. If the mesh reaches into the corners, as a box does, it is wider:
    /// by a factor of 1.24, which gives it the volume of the box, or for a plate by 1.13, which gives it the area
    /// of the plate. The largest distance of a vertex from the centre decides between the two cases, with a smooth
    /// transition, and the two smaller extents decide what counts as a plate.
    pub fn of_caster(caster: &Caster) -> Self {
        let bounds = caster.mesh.bounds();
        let reached = caster.mesh.radius_under(&DMat3::IDENTITY);
        let half = half_extents(&bounds);
        let (largest, corner) = (half.max_element(), half.length());
        let range = corner * corner - largest * largest;
        let to_corners = match range > 0.0 {
            true => ((reached * reached - largest * largest) / range).clamp(0.0, 1.0),
            false => 0.0,
        };
        Self::fitted(&bounds, caster, 1.0 + to_corners * (as_large(half) - 1.0))
    }

    /// The ellipsoid that touches the sides of a box in a caster's space, wider by `scale`.
    fn fitted(bounds: &Bounds, caster: &Caster, scale: f64) -> Self {
        let centre = (bounds.min.as_dvec3() + bounds.max.as_dvec3()) * 0.5;
        let half = half_extents(bounds) * scale;
        let map = caster.transform();
        let axes = map.matrix3 * DMat3::from_diagonal(half);
        Self {
            centre: map.transform_point3(centre).as_vec3(),
            axes: [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.as_vec3()),
            opacity: 1.0,
        }
    }

    /// The same ellipsoid, scaled by `factor`.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            axes: self.axes.map(|axis| axis * factor),
            ..self
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.centre.is_finite() && self.axes.iter().all(|axis| axis.is_finite())
    }

    /// The map from the unit sphere, about the centre.
    pub(super) fn linear(&self) -> DMat3 {
        let [x, y, z] = self.axes.map(|axis| axis.as_dvec3());
        DMat3::from_cols(x, y, z)
    }
}

/// How much wider an ellipsoid is to be that stands for a box.
fn as_large(half: DVec3) -> f64 {
    let smallest = half.min_element();
    let middle = half.element_sum() - smallest - half.max_element();
    let roundness = if middle > 0.0 { smallest / middle } else { 1.0 };
    SAME_AREA + roundness * (SAME_VOLUME - SAME_AREA)
}

fn half_extents(bounds: &Bounds) -> DVec3 {
    (bounds.max.as_dvec3() - bounds.min.as_dvec3()) * 0.5
}
