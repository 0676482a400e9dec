//! Lights, and their homogeneous form.

use glam::{DVec3, Vec3, Vec4};

use crate::error::LightError;

/// A light that shines from one point in all directions, up to a range.
///
/// World space, any unit of length, as long as `near` and `range` are in the same one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Position in world space.
    pub position: Vec3,
    /// Distance along the major axis at which the shadow map's frusta begin; greater than 0.
    ///
    /// Casters (or parts of them) nearer than this are not in a [`CubeShadowMap`]. Shadow volumes
    /// do not use it. With infinite reverse-Z a small value costs no precision
    /// (Upchurch and Desbrun, "Tightening the Precision of Perspective Rendering", 2012).
    ///
    /// [`CubeShadowMap`]: crate::CubeShadowMap
    pub near: f32,
    /// Distance beyond which the light has no effect; greater than `near`.
    ///
    /// Casters wholly beyond it are not drawn. A receiver beyond it is unlit by this light:
    /// [`PcfSampler`](crate::PcfSampler) returns visibility 0 there.
    pub range: f32,
}

impl PointLight {
    /// A point light; `near` and `range` in world units.
    pub fn new(position: Vec3, near: f32, range: f32) -> Self {
        Self {
            position,
            near,
            range,
        }
    }

    /// Checks that every number is finite and `0 < near < range`.
    ///
    /// # Errors
    /// [`LightError`] names the field that is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        if !self.position.is_finite() {
            return Err(LightError::Position(self.position.to_array()));
        }
        if !(self.range.is_finite() && self.range > 0.0) {
            return Err(LightError::Range(self.range));
        }
        if !(self.near.is_finite() && self.near > 0.0 && self.near < self.range) {
            return Err(LightError::Near {
                near: self.near,
                range: self.range,
            });
        }
        Ok(())
    }

    /// The light as `(position, 1)`.
    pub fn homogeneous(&self) -> HomogeneousLight {
        HomogeneousLight(self.position.extend(1.0))
    }
}

/// A light as a point of projective space: `w = 1` for a point light at `xyz`, `w = 0` for a
/// directional light that shines *from* the direction `xyz` (of any length but 0).
///
/// This is the form in which shadow volumes take their light, so that one code path serves both
/// kinds (Everitt and Kilgard, "Practical and Robust Stenciled Shadow Volumes", 2002).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomogeneousLight(pub Vec4);

impl HomogeneousLight {
    /// A light at a point of world space.
    pub fn point(position: Vec3) -> Self {
        Self(position.extend(1.0))
    }

    /// A light at a point of world space in f64, in a world whose coordinates are counted from
    /// `origin`: see [`Caster::placed`](crate::Caster::placed). A directional light is the same from
    /// everywhere.
    pub fn placed(position: DVec3, origin: DVec3) -> Self {
        Self::point((position - origin).as_vec3())
    }

    /// A light infinitely far away; `toward_light` points from the scene to the light.
    pub fn directional(toward_light: Vec3) -> Self {
        Self(toward_light.extend(0.0))
    }

    /// Whether the light is infinitely far away (`w = 0`).
    pub fn is_directional(&self) -> bool {
        self.0.w == 0.0
    }

    /// Checks that the numbers are finite, that `w` is 0 or 1 and that a direction is not zero.
    ///
    /// # Errors
    /// [`LightError`] names what is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        let light = self.0;
        if !light.is_finite() {
            return Err(LightError::Position(light.truncate().to_array()));
        }
        if light.w != 0.0 && light.w != 1.0 {
            return Err(LightError::Homogeneous(light.w));
        }
        if light.w == 0.0 && light.truncate() == Vec3::ZERO {
            return Err(LightError::Direction);
        }
        Ok(())
    }
}

impl From<PointLight> for HomogeneousLight {
    fn from(light: PointLight) -> Self {
        light.homogeneous()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sound_light_passes() {
        assert_eq!(PointLight::new(Vec3::ONE, 0.1, 30.0).validate(), Ok(()));
        assert_eq!(HomogeneousLight::directional(Vec3::Y).validate(), Ok(()));
    }

    #[test]
    fn each_bad_field_is_named() {
        let light = PointLight::new(Vec3::ZERO, 0.1, 30.0);
        let position = Vec3::new(f32::NAN, 0.0, 0.0);
        assert!(matches!(
            PointLight { position, ..light }.validate(),
            Err(LightError::Position(_))
        ));
        for range in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
            assert!(matches!(
                PointLight { range, ..light }.validate(),
                Err(LightError::Range(_))
            ));
        }
        for near in [f32::NAN, 0.0, -1.0, 30.0, 31.0] {
            assert!(matches!(
                PointLight { near, ..light }.validate(),
                Err(LightError::Near { .. })
            ));
        }
        assert_eq!(
            HomogeneousLight(Vec4::new(1.0, 0.0, 0.0, 0.5)).validate(),
            Err(LightError::Homogeneous(0.5))
        );
        assert_eq!(
            HomogeneousLight(Vec4::ZERO).validate(),
            Err(LightError::Direction)
        );
        assert!(matches!(
            HomogeneousLight(Vec4::new(f32::INFINITY, 0.0, 0.0, 1.0)).validate(),
            Err(LightError::Position(_))
        ));
    }
}
