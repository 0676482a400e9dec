//! Where a caster is, with what f32 arithmetic may add.

use glam::{DVec3, Vec4Swizzles as _};

use crate::{Caster, HomogeneousLight};

/// The bounds of a caster in world space: what is common to its turned box, the axis-aligned box
/// around that, and a sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WorldBox {
    centre: DVec3,
    /// Half extents along the world's axes, rounding included.
    half: DVec3,
    /// Half the edges of the turned box.
    axes: [DVec3; 3],
    radius: f64,
    slack: DVec3,
}

impl WorldBox {
    /// An axis-aligned box.
    #[cfg(test)]
    pub fn new(centre: DVec3, half: DVec3) -> Self {
        Self {
            centre,
            half,
            axes: [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z],
            radius: half.length(),
            slack: DVec3::ZERO,
        }
    }

    pub fn of(caster: &Caster) -> Self {
        let map = caster.transform();
        let bounds = caster.mesh.bounds();
        let (centre, half) = bounds.transformed(&map);
        let reach = bounds.min.abs().max(bounds.max.abs()).as_dvec3();
        let m = map.matrix3;
        let magnitude = m.x_axis.abs() * reach.x
            + m.y_axis.abs() * reach.y
            + m.z_axis.abs() * reach.z
            + map.translation.abs();
        let slack = rounding(magnitude);
        let edge = (bounds.max.as_dvec3() - bounds.min.as_dvec3()) * 0.5;
        Self {
            centre,
            half: half + slack,
            axes: [m.x_axis * edge.x, m.y_axis * edge.y, m.z_axis * edge.z],
            radius: caster.mesh.radius_under(&m),
            slack,
        }
    }

    /// The middle of the box.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Distance from a point; 0 inside.
    pub fn distance(&self, point: DVec3) -> f64 {
        let outside = (point - self.centre).abs() - self.half - rounding(point.abs());
        outside.max(DVec3::ZERO).length()
    }

    /// The greatest distance from a point.
    pub fn reach(&self, point: DVec3) -> f64 {
        self.centre.distance(point) + self.radius + self.slack.length()
    }

    /// The least of `normal . p` over the points p of the box.
    pub fn nearest(&self, normal: DVec3) -> f64 {
        normal.dot(self.centre) - self.extent(normal)
    }

    /// The greatest of `normal . p` over the points p of the box.
    pub fn farthest(&self, normal: DVec3) -> f64 {
        normal.dot(self.centre) + self.extent(normal)
    }

    fn extent(&self, normal: DVec3) -> f64 {
        let turned: f64 = self.axes.iter().map(|axis| normal.dot(*axis).abs()).sum();
        let sphere = self.radius * normal.length();
        turned.min(sphere) + normal.abs().dot(self.slack)
    }

    /// Whether the light is certainly outside the box.
    pub fn excludes(&self, light: HomogeneousLight) -> bool {
        light.is_directional() || self.distance(light.0.xyz().as_dvec3()) > 0.0
    }
}

/// More than the roundings of vertex shaders move a vertex from its place in the picture, if its distance
/// from the world's origin and the eye's add up to `distances`: in world units, across whatever surface.
///
/// With u = 2^-24: each of three world coordinates is a sum of four products and wrong by 4 u of the
/// vertex's distance; and each of three rows of the clip matrix (x, y and w; depth follows w) by 4 u of
/// the two distances, in units of the row's length. sqrt(3) (4 u + 4 u) is 13.9 u.
pub(crate) fn displacement(distances: f64) -> f64 {
    distances * (8.0 * f64::from(f32::EPSILON))
}

/// More than a vertex shader's roundings can move a coordinate whose terms have this magnitude.
pub(crate) fn rounding(magnitude: DVec3) -> DVec3 {
    magnitude * (4.0 * f64::from(f32::EPSILON))
}
