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

/// A light that shines from one point into a cone, up to a range.
///
/// World space, any unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Position in world space.
    pub position: Vec3,
    /// Where it shines, of any length but 0.
    pub direction: Vec3,
    /// Angle from the direction to the cone's side, in radians; greater than 0, less than pi / 2.
    /// The map's square is drawn around the cone. How light falls off toward the side is the
    /// host's: the map knows shadows only, and what is outside it is lit.
    pub half_angle: f32,
    /// Distance along the direction at which the shadow map's frustum begins; greater than 0.
    /// Casters nearer than this are pulled onto that plane where the device has
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL), and are lost elsewhere.
    pub near: f32,
    /// Distance beyond which the light has no effect; greater than `near`. A receiver beyond it is
    /// unlit by this light: visibility 0.
    pub range: f32,
}

impl SpotLight {
    /// Checks that every number is finite and in its range.
    ///
    /// # Errors
    /// [`LightError`] names the field that is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        PointLight::new(self.position, self.near, self.range).validate()?;
        DirectionalLight::new(self.direction).validate()?;
        if self.half_angle > 0.0 && self.half_angle < std::f32::consts::FRAC_PI_2 {
            Ok(())
        } else {
            Err(LightError::HalfAngle(self.half_angle))
        }
    }

    /// The light as `(position, 1)`.
    pub fn homogeneous(&self) -> HomogeneousLight {
        HomogeneousLight::point(self.position)
    }
}

/// A light so far away that its rays are parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// From the scene to the light, in world space, of any length but 0.
    pub toward_light: Vec3,
}

impl DirectionalLight {
    /// A light that shines *from* the direction `toward_light`.
    pub fn new(toward_light: Vec3) -> Self {
        Self { toward_light }
    }

    /// Checks that the direction is finite and not 0.
    ///
    /// # Errors
    /// [`LightError`] says what is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        self.homogeneous().validate()
    }

    /// The light as `(toward_light, 0)`.
    pub fn homogeneous(&self) -> HomogeneousLight {
        HomogeneousLight::directional(self.toward_light)
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

impl From<SpotLight> for HomogeneousLight {
    fn from(light: SpotLight) -> Self {
        light.homogeneous()
    }
}

impl From<DirectionalLight> for HomogeneousLight {
    fn from(light: DirectionalLight) -> Self {
        light.homogeneous()
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
    fn a_cone_must_be_one() {
        let light = SpotLight {
            position: Vec3::ONE,
            direction: Vec3::NEG_Y,
            half_angle: 0.5,
            near: 0.1,
            range: 10.0,
        };
        assert_eq!(light.validate(), Ok(()));
        for half_angle in [0.0, -0.1, 1.6, f32::INFINITY] {
            let wrong = SpotLight {
                half_angle,
                ..light
            };
            assert_eq!(wrong.validate(), Err(LightError::HalfAngle(half_angle)));
        }
        let direction = Vec3::ZERO;
        let wrong = SpotLight { direction, ..light };
        assert_eq!(wrong.validate(), Err(LightError::Direction));
        let wrong = SpotLight { near: 0.0, ..light };
        assert!(matches!(wrong.validate(), Err(LightError::Near { .. })));
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
