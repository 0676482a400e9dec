//! The input of one frame: a light with a size, a rectangle, and casters.

use glam::Vec3;

use crate::error::PlanarSoftShadowError;
use crate::{Caster, Light};

/// The shape of an area light, centred on the position of the light. In world units, or for a directional light
/// (whose position is its direction at length 1) in tangents of angles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightShape {
    /// A sphere, seen as a disk from everywhere. For a directional light, a disk perpendicular to its
    /// direction.
    Sphere {
        /// Above 0. A light is never larger than far away: below its height above the plane, or part of it is
        /// behind the plane and lights nothing.
        radius: f32,
    },
    /// A disk that shines from both sides.
    Disk {
        /// Above 0.
        radius: f32,
        /// Across it, of any length but 0.
        normal: Vec3,
    },
    /// A parallelogram that shines from both sides.
    Rectangle {
        /// From its middle to the middle of one side.
        half_width: Vec3,
        /// From its middle to the middle of a side beside that.
        half_height: Vec3,
    },
}

/// The part of a plane that receives: a rectangle or any other parallelogram, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarRectangle {
    /// One of its corners.
    pub corner: Vec3,
    /// From there to the next corner.
    pub width: Vec3,
    /// From `corner` to the other neighbouring corner. The rectangle receives on the side that
    /// `width x height` points to.
    pub height: Vec3,
}

/// One frame of a [`PlanarSoftShadow`](crate::PlanarSoftShadow).
#[derive(Clone, Copy, Debug)]
pub struct PlanarSoftFrame<'a> {
    /// The centre of the light. A spot shines in all directions here: applying its cone is up to the host.
    pub light: Light,
    /// Its shape.
    pub shape: LightShape,
    /// The receiver.
    pub receiver: PlanarRectangle,
    /// The casters.
    pub casters: &'a [Caster],
}

impl PlanarSoftFrame<'_> {
    pub(super) fn validate(&self) -> Result<(), PlanarSoftShadowError> {
        self.light.validate()?;
        let size_of = |vector: &Vec3| vector.is_finite() && *vector != Vec3::ZERO;
        let positive = |radius: f32| radius.is_finite() && radius > 0.0;
        let sound = match &self.shape {
            LightShape::Sphere { radius } => positive(*radius),
            LightShape::Disk { radius, normal } => positive(*radius) && size_of(normal),
            LightShape::Rectangle {
                half_width,
                half_height,
            } => size_of(half_width) && size_of(half_height),
        };
        if !sound {
            return Err(PlanarSoftShadowError::Shape(self.shape));
        }
        let PlanarRectangle {
            corner,
            width,
            height,
        } = self.receiver;
        let normal = self.receiver.normal();
        let flat = normal.length() / (width.as_dvec3().length() * height.as_dvec3().length());
        match corner.is_finite() && flat > f64::from(f32::EPSILON) {
            true => Ok(()),
            false => Err(PlanarSoftShadowError::Rectangle(self.receiver)),
        }
    }
}

impl PlanarRectangle {
    /// Toward the side that receives, of any length.
    pub(super) fn normal(&self) -> glam::DVec3 {
        self.width.as_dvec3().cross(self.height.as_dvec3())
    }
}
