//! Where a caster is, and half-spaces that it may reach into.

use glam::{DVec3, Vec3};

use crate::mesh::Caster;

/// A box and a sphere with the same centre, both around a caster.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CasterBounds {
    pub centre: DVec3,
    /// Half extents of the box.
    pub half: DVec3,
    pub radius: f64,
}

impl CasterBounds {
    /// In world space.
    pub fn of(caster: &Caster) -> Self {
        let transform = caster.transform();
        let (centre, half) = caster.mesh.bounds().transformed(&transform);
        Self {
            centre,
            half,
            radius: caster.mesh.radius_under(&transform.matrix3),
        }
    }

    /// Around all of a box.
    pub fn of_box(min: DVec3, max: DVec3) -> Self {
        let half = (max - min) * 0.5;
        Self {
            centre: min + half,
            half,
            radius: half.length(),
        }
    }

    /// Counted from another origin.
    pub fn relative_to(&self, origin: Vec3) -> Self {
        Self {
            centre: self.centre - origin.as_dvec3(),
            ..*self
        }
    }

    /// How far they extend from their centre along a normal of this length, times that length.
    pub fn extent(&self, normal: DVec3, length: f64) -> f64 {
        normal.abs().dot(self.half).min(self.radius * length)
    }

    /// Half the size of a box around them along three axes of length 1.
    pub fn half_along(&self, axes: [DVec3; 3]) -> DVec3 {
        DVec3::from_array(axes.map(|axis| axis.abs().dot(self.half))).min(DVec3::splat(self.radius))
    }
}

/// All points for which `normal . point + offset` is not negative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace {
    pub normal: DVec3,
    /// Of the normal.
    pub length: f64,
    pub offset: f64,
}

impl HalfSpace {
    pub fn new(normal: DVec3, offset: f64) -> Self {
        Self {
            normal,
            length: normal.length(),
            offset,
        }
    }

    /// Whether any point of some bounds may be inside.
    pub fn touches(&self, bounds: &CasterBounds) -> bool {
        let room = bounds.extent(self.normal, self.length);
        self.normal.dot(bounds.centre) + self.offset + room >= 0.0
    }

    /// Whether all points of some bounds are inside.
    pub fn holds(&self, bounds: &CasterBounds) -> bool {
        let room = bounds.extent(self.normal, self.length);
        self.normal.dot(bounds.centre) + self.offset - room >= 0.0
    }
}
