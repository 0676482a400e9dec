//! A light above a plane.

use glam::{DVec2, DVec3, DVec4, Vec4Swizzles as _};

use super::axes::PlaneAxes;
use crate::Light;
use crate::scene::CasterBounds;

/// What of a caster casts on a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Casts {
    /// All of it: it is wholly between plane and light.
    Whole,
    /// Perhaps a part: the shader finds out which.
    Part,
    /// Nothing: it is behind the plane, or behind the light as seen from the plane.
    Nothing,
    /// Nothing that the light reaches.
    Beyond,
}

/// How high above a plane a light is, for the rounding of its distance in f64.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Of a light's height: as near to it as that, the shader may find a caster on either side of it.
const AS_HIGH: f64 = 1.0 - 1e-6;

/// A light in front of a plane, in the plane's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlaneLight {
    /// By how much a unit of height moves a shadow along the plane.
    pub slope: DVec2,
    /// Its place; `None` for a directional light.
    pub place: Option<DVec3>,
    /// Its end, if it has one.
    range: Option<f64>,
    /// Of a spot: where it shines, of length 1, and the cosine of its half angle.
    pub cone: Option<(DVec3, f64)>,
}

impl PlaneLight {
    /// `None` where the light is in the plane or behind it, and so casts nothing on its front.
    pub fn new(axes: &PlaneAxes, light: &Light) -> Option<Self> {
        let (place, cone) = match light {
            Light::Point(point) => (point.homogeneous(), None),
            Light::Spot(spot) => {
                let axis = axes.direction(spot.direction.as_dvec3().normalize());
                let cone = Some((axis, f64::from(spot.half_angle).cos()));
                (spot.homogeneous(), cone)
            }
            Light::Directional(sun) => (sun.homogeneous(), None),
        };
        let endless = Self::of_place(axes, place.0.as_dvec4())?;
        let seen = Self { cone, ..endless };
        Some(seen.with_end_of(light))
    }

    /// A light without end, homogeneous.
    pub fn of_place(axes: &PlaneAxes, light: DVec4) -> Option<Self> {
        let (place, size) = match light.w {
            0.0 => (axes.direction(light.xyz().normalize()), 1.0),
            _ => {
                let size = light.xyz().abs().max(axes.origin.abs()).max_element();
                (axes.place(light.xyz()), size)
            }
        };
        (place.z > ROUNDING * size).then(|| Self {
            slope: place.truncate() / place.z,
            place: (light.w != 0.0).then_some(place),
            range: None,
            cone: None,
        })
    }

    /// With the range of another, of the same kind.
    pub fn with_end_of(self, light: &Light) -> Self {
        let range = match light {
            Light::Point(point) => Some(f64::from(point.range)),
            Light::Spot(spot) => Some(f64::from(spot.range)),
            Light::Directional(_) => None,
        };
        Self { range, ..self }
    }

    /// What a unit of height takes from the shadow's w.
    pub fn inverse_height(&self) -> f64 {
        self.place.map_or(0.0, |place| 1.0 / place.z)
    }

    /// 1 over the range; 0 where there is none.
    pub fn inverse_range(&self) -> f64 {
        self.range.map_or(0.0, |range| 1.0 / range)
    }

    /// What of a caster casts on the plane.
    pub fn casts(&self, axes: &PlaneAxes, bounds: &CasterBounds) -> Casts {
        let centre = axes.place(bounds.centre);
        let extent = bounds.extent(axes.normal, 1.0);
        let (low, high) = (centre.z - extent, centre.z + extent);
        let light = self.place.unwrap_or(DVec3::INFINITY);
        if high <= 0.0 || low >= light.z {
            return Casts::Nothing;
        }
        let is_far = |range| centre.distance(light) - bounds.radius > range;
        if self.range.is_some_and(is_far) {
            return Casts::Beyond;
        }
        match low >= 0.0 && high <= AS_HIGH * light.z {
            true => Casts::Whole,
            false => Casts::Part,
        }
    }
}
