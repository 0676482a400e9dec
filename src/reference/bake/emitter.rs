//! The light that is baked, and sample points on it.

use std::f64::consts::TAU;

use glam::{DVec3, DVec4, Vec3, Vec4Swizzles as _};

use crate::error::LightMapError;
use crate::reference::image::Lighting;
use crate::{Light, SpotLight};

/// The shape of a baked light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Emitter {
    /// A point, or a single direction: hard shadows. The default.
    #[default]
    Point,
    /// A sphere, treated as the disk through its centre that faces the receiver, as in
    /// [`ReferenceImage::area_visibility`](crate::reference::ReferenceImage::area_visibility).
    Sphere {
        /// World units, finite, above 0; of a directional light the tangent of its angular radius (the sun's: 0.00465).
        radius: f32,
    },
    /// A rectangle around a point light or a spot, which shines from both sides.
    Rectangle {
        /// From the middle to two neighbouring sides, in world units, world space; finite and not parallel.
        half_sides: [Vec3; 2],
    },
}

/// A static light, to be baked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakedLight {
    light: Light,
    emitter: Emitter,
}

impl BakedLight {
    /// A light without a size. Its range and cone are not baked in: the host has no light to multiply outside them.
    /// The light's `near` is for maps and ignored.
    pub fn new(light: impl Into<Light>) -> Self {
        Self {
            light: light.into(),
            emitter: Emitter::Point,
        }
    }

    /// The same light with a size.
    #[must_use]
    pub fn with_emitter(mut self, emitter: Emitter) -> Self {
        self.emitter = emitter;
        self
    }

    /// The light.
    pub fn light(&self) -> Light {
        self.light
    }

    /// Its shape.
    pub fn emitter(&self) -> Emitter {
        self.emitter
    }

    pub(super) fn validate(&self) -> Result<(), LightMapError> {
        self.light.validate()?;
        match self.emitter {
            Emitter::Point => Ok(()),
            Emitter::Sphere { radius } if radius.is_finite() && radius > 0.0 => Ok(()),
            Emitter::Sphere { radius } => Err(LightMapError::Radius(radius)),
            Emitter::Rectangle { half_sides } => {
                let [a, b] = half_sides.map(Vec3::as_dvec3);
                let area = a.cross(b);
                let is_placed = !matches!(self.light, Light::Directional(_));
                match is_placed && area.is_finite() && area != DVec3::ZERO {
                    true => Ok(()),
                    false => Err(LightMapError::Rectangle {
                        half_sides: half_sides.map(|side| side.to_array()),
                    }),
                }
            }
        }
    }

    /// Of a valid light.
    pub(super) fn prepared(&self) -> PreparedLight {
        let of_spot = |spot: &SpotLight| Lighting::of_spot(spot);
        let lighting = match &self.light {
            Light::Point(light) => Lighting::new(light.homogeneous(), Some(light.range)),
            Light::Spot(light) => of_spot(light),
            Light::Directional(light) => Lighting::new(light.homogeneous(), None),
        };
        PreparedLight {
            lighting,
            emitter: self.emitter,
        }
    }
}

/// A light as its rays need it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PreparedLight {
    pub lighting: Lighting,
    emitter: Emitter,
}

impl PreparedLight {
    /// Its middle, or its direction.
    pub fn centre(&self) -> DVec4 {
        self.lighting.light
    }

    /// A place on it as seen from `position`, by two numbers in 0 to 1: uniform over its area.
    pub fn place(&self, position: DVec3, [s, t]: [f64; 2]) -> DVec4 {
        let light = self.centre();
        let place = match self.emitter {
            Emitter::Point => return light,
            Emitter::Sphere { radius } => {
                let toward = light.xyz() - light.w * position;
                let (across, along) = toward.normalize().any_orthonormal_pair();
                let radius = match light.w {
                    0.0 => f64::from(radius) * toward.length(),
                    _ => f64::from(radius),
                };
                let (sine, cosine) = (TAU * t).sin_cos();
                light.xyz() + radius * s.sqrt() * (cosine * across + sine * along)
            }
            Emitter::Rectangle { half_sides } => {
                let [a, b] = half_sides.map(Vec3::as_dvec3);
                light.xyz() + (2.0 * s - 1.0) * a + (2.0 * t - 1.0) * b
            }
        };
        place.extend(light.w)
    }
}
