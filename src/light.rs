//! Lights, and their homogeneous form.

use glam::{DVec3, Vec3, Vec4};

use crate::error::LightError;

/// A light that shines from one point in all directions, up to a range.
///
/// World space, any unit of length, as long as `near` and `range` are in the same one.
///
/// ```
/// use shadows::{PointLight, glam::Vec3};
/// let lamp = PointLight::new(Vec3::new(0.0, 4.0, 1.0), 30.0);
/// // Only where a host has a reason, such as a lamp inside its own bulb.
/// let bulb = PointLight { near: Some(0.05), ..lamp };
/// # assert!(bulb.validate().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Position in world space.
    pub position: Vec3,
    /// Distance beyond which the light has no effect; greater than 0.
    ///
    /// Casters that lie entirely beyond it are not drawn. A receiver beyond it is not lit by this light:
    /// [`PcfSampler`](crate::PcfSampler) returns visibility 0 there.
    pub range: f32,
    /// Distance along the major axis at which the frusta of a [`CubeShadowMap`] begin; greater than 0, less
    /// than `range`, and at least 1.2e-38 times `range`. Shadow volumes do not use it.
    ///
    /// `None` (default) lets the map choose. In the usual format, `Depth32Float`, that is 2^-24 of the range:
    /// with infinite reverse-Z in floats a small value costs no precision (Upchurch and Desbrun, "Tightening
    /// the Precision of Perspective Rendering", 2012). In fixed point it would, so the map uses the square
    /// root of the format's step: 1/256 of the range for `Depth16Unorm`, 1/4096 for `Depth24Plus`. The depth
    /// step at the range then equals the distance of the near plane.
    /// [`LinearDistance`](crate::DepthEncoding::LinearDistance) uses 2^-24 in every format.
    ///
    /// Casters nearer than this are pulled onto that plane where the device has
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL) and on GL, and so cast on everything beyond it;
    /// elsewhere they cast nothing. Receivers in front of the plane are lit.
    ///
    /// [`CubeShadowMap`]: crate::CubeShadowMap
    pub near: Option<f32>,
}

impl PointLight {
    /// A point light; `range` in world units. The map chooses its near plane.
    pub fn new(position: Vec3, range: f32) -> Self {
        Self {
            position,
            range,
            near: None,
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
        if !(self.range.is_normal() && self.range > 0.0) {
            return Err(LightError::Range(self.range));
        }
        match self.near {
            Some(near) if !is_near_plane(near, self.range) => Err(LightError::Near {
                near,
                range: self.range,
            }),
            _ => Ok(()),
        }
    }

    /// The light as `(position, 1)`.
    pub fn homogeneous(&self) -> HomogeneousLight {
        HomogeneousLight::point(self.position)
    }
}

/// A light that shines from one point into a cone, up to a range.
///
/// World space, any unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Position in world space.
    pub position: Vec3,
    /// The direction in which it shines, of any length but 0.
    pub direction: Vec3,
    /// Angle between the direction and the cone's side, in radians; greater than 0, less than pi / 2. The map
    /// is a square around the cone. The falloff toward the side is up to the host: the map holds nothing but
    /// shadows, and everything outside it is lit.
    pub half_angle: f32,
    /// Distance beyond which the light has no effect; greater than 0. A receiver beyond it is not lit by this
    /// light: visibility 0.
    pub range: f32,
    /// Distance along the direction at which the shadow map's frustum begins. `None` (default) lets the map
    /// choose: see [`PointLight::near`].
    pub near: Option<f32>,
}

impl SpotLight {
    /// A spot; `half_angle` in radians, `range` in world units. The map chooses its near plane.
    pub fn new(position: Vec3, direction: Vec3, half_angle: f32, range: f32) -> Self {
        Self {
            position,
            direction,
            half_angle,
            range,
            near: None,
        }
    }

    /// The same light shining all around.
    fn all_around(&self) -> PointLight {
        PointLight {
            position: self.position,
            range: self.range,
            near: self.near,
        }
    }

    /// Checks that every number is finite and in its range.
    ///
    /// # Errors
    /// [`LightError`] names the field that is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        self.all_around().validate()?;
        check_cone(self.direction, self.half_angle)
    }

    /// The light as `(position, 1)`.
    pub fn homogeneous(&self) -> HomogeneousLight {
        HomogeneousLight::point(self.position)
    }
}

/// Whether a map may begin there: the depth at the range, `near / range`, must not be so small that
/// GPUs take it for 0, which means that there is no caster.
fn is_near_plane(near: f32, range: f32) -> bool {
    near > 0.0 && near < range && (near / range).is_normal()
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

/// A light of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Light {
    /// From one point in all directions.
    Point(PointLight),
    /// From one point into a cone.
    Spot(SpotLight),
    /// From so far away that its rays are parallel.
    Directional(DirectionalLight),
}

impl Light {
    /// Checks that its numbers are in range.
    ///
    /// # Errors
    /// [`LightError`] names the field that is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        match self {
            Self::Point(light) => light.validate(),
            Self::Spot(light) => light.validate(),
            Self::Directional(light) => light.validate(),
        }
    }
}

impl From<PointLight> for Light {
    fn from(light: PointLight) -> Self {
        Self::Point(light)
    }
}

impl From<SpotLight> for Light {
    fn from(light: SpotLight) -> Self {
        Self::Spot(light)
    }
}

impl From<DirectionalLight> for Light {
    fn from(light: DirectionalLight) -> Self {
        Self::Directional(light)
    }
}

/// A light as a point of projective space: `w = 1` for a point light at `xyz`, `w = 0` for a
/// directional light that shines *from* the direction `xyz` (of any length but 0).
///
/// Shadow volumes take lights in this form, so that one code path serves both kinds (Everitt and Kilgard,
/// "Practical and Robust Stenciled Shadow Volumes", 2002).
///
/// It converts from any kind of light, and by `try_from` from a vector, which rejects any other `w`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomogeneousLight(pub(crate) Vec4);

impl HomogeneousLight {
    /// A light at a point of world space.
    pub const fn point(position: Vec3) -> Self {
        Self(Vec4::new(position.x, position.y, position.z, 1.0))
    }

    /// A light at a point of world space in f64, for a host that renders relative to `origin`: see
    /// [`Caster::placed`](crate::Caster::placed). A directional light does not depend on the origin.
    pub fn placed(position: DVec3, origin: DVec3) -> Self {
        Self::point((position - origin).as_vec3())
    }

    /// A light infinitely far away; `toward_light` points from the scene to the light.
    pub const fn directional(toward_light: Vec3) -> Self {
        Self(Vec4::new(
            toward_light.x,
            toward_light.y,
            toward_light.z,
            0.0,
        ))
    }

    /// The position and 1, or the direction to the light and 0.
    pub fn xyzw(&self) -> Vec4 {
        self.0
    }

    /// Whether the light is infinitely far away (`w = 0`).
    pub fn is_directional(&self) -> bool {
        self.0.w == 0.0
    }

    /// Checks that the numbers are finite and that a direction is not zero.
    ///
    /// # Errors
    /// [`LightError`] names what is wrong.
    pub fn validate(&self) -> Result<(), LightError> {
        let light = self.0;
        if !light.is_finite() {
            return Err(LightError::Position(light.truncate().to_array()));
        }
        if light.w == 0.0 && light.truncate() == Vec3::ZERO {
            return Err(LightError::Direction);
        }
        Ok(())
    }
}

impl TryFrom<Vec4> for HomogeneousLight {
    type Error = LightError;

    /// # Errors
    /// [`LightError`] if `w` is neither 0 nor 1, or as [`validate`](Self::validate) says.
    fn try_from(light: Vec4) -> Result<Self, LightError> {
        if light.w != 0.0 && light.w != 1.0 {
            return Err(LightError::Homogeneous(light.w));
        }
        let light = Self(light);
        light.validate()?;
        Ok(light)
    }
}

impl From<Light> for HomogeneousLight {
    fn from(light: Light) -> Self {
        match light {
            Light::Point(light) => light.homogeneous(),
            Light::Spot(light) => light.homogeneous(),
            Light::Directional(light) => light.homogeneous(),
        }
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

/// Whether a spot's axis and its half angle make a cone.
pub(crate) fn check_cone(direction: Vec3, half_angle: f32) -> Result<(), LightError> {
    if !direction.is_finite() || direction == Vec3::ZERO {
        return Err(LightError::SpotDirection(direction.to_array()));
    }
    match half_angle > 0.0 && half_angle < std::f32::consts::FRAC_PI_2 {
        true => Ok(()),
        false => Err(LightError::HalfAngle(half_angle)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sound_light_passes() {
        assert_eq!(PointLight::new(Vec3::ONE, 30.0).validate(), Ok(()));
        let near = Some(0.1);
        let light = PointLight {
            near,
            ..PointLight::new(Vec3::ONE, 30.0)
        };
        assert_eq!(light.validate(), Ok(()));
        assert_eq!(HomogeneousLight::directional(Vec3::Y).validate(), Ok(()));
    }

    #[test]
    fn a_cone_must_be_one() {
        let light = SpotLight::new(Vec3::ONE, Vec3::NEG_Y, 0.5, 10.0);
        assert_eq!(light.validate(), Ok(()));
        for half_angle in [0.0, -0.1, 1.6, f32::INFINITY] {
            let wrong = SpotLight {
                half_angle,
                ..light
            };
            assert_eq!(wrong.validate(), Err(LightError::HalfAngle(half_angle)));
        }
        for direction in [Vec3::ZERO, Vec3::INFINITY] {
            let wrong = SpotLight { direction, ..light };
            let error = wrong.validate().unwrap_err();
            assert_eq!(error, LightError::SpotDirection(direction.to_array()));
            assert!(!error.to_string().contains("directional"), "{error}");
        }
        let near = Some(0.0);
        let wrong = SpotLight { near, ..light };
        assert!(matches!(wrong.validate(), Err(LightError::Near { .. })));
    }

    #[test]
    fn each_bad_field_is_named() {
        let light = PointLight::new(Vec3::ZERO, 30.0);
        let position = Vec3::new(f32::NAN, 0.0, 0.0);
        assert!(matches!(
            PointLight { position, ..light }.validate(),
            Err(LightError::Position(_))
        ));
        for range in [f32::NAN, f32::INFINITY, 0.0, -1.0, 1e-40] {
            assert!(matches!(
                PointLight { range, ..light }.validate(),
                Err(LightError::Range(_))
            ));
        }
        for near in [f32::NAN, 0.0, -1.0, 30.0, 31.0, f32::INFINITY, 1e-40, 2e-37] {
            let near = Some(near);
            assert!(matches!(
                PointLight { near, ..light }.validate(),
                Err(LightError::Near { .. })
            ));
        }
        let directionless = HomogeneousLight::directional(Vec3::ZERO);
        assert_eq!(directionless.validate(), Err(LightError::Direction));
        assert!(matches!(
            HomogeneousLight::point(Vec3::new(f32::INFINITY, 0.0, 0.0)).validate(),
            Err(LightError::Position(_))
        ));
    }

    #[test]
    fn a_vector_is_a_light_if_its_w_is_0_or_1() {
        let of = |w: f32| HomogeneousLight::try_from(Vec4::new(1.0, 2.0, 3.0, w));
        let place = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(of(1.0), Ok(HomogeneousLight::point(place)));
        assert_eq!(of(0.0), Ok(HomogeneousLight::directional(place)));
        for w in [0.5, -1.0, 2.0, 1e-3] {
            assert_eq!(of(w), Err(LightError::Homogeneous(w)));
        }
        assert!(matches!(of(f32::NAN), Err(LightError::Homogeneous(_))));
        let directionless = HomogeneousLight::try_from(Vec4::ZERO);
        assert_eq!(directionless, Err(LightError::Direction));
    }
}
