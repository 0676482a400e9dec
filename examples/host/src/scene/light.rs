//! The lights of a scene, and its sky.

use shadows::HomogeneousLight;
use shadows::glam::{Vec3, Vec4};

/// The kinds of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// In all directions from one place.
    Point,
    /// From one place into a cone.
    Spot,
    /// Parallel.
    Directional,
}

impl LightKind {
    /// In reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Spot => "spot",
            Self::Directional => "directional",
        }
    }
}

/// Where a spot shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Of any length but 0, world space.
    pub direction: Vec3,
    /// From the direction to the cone's side, in radians.
    pub half_angle: f32,
}

/// A light of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Homogeneous, world space: a point (w = 1) or the direction to the light (w = 0).
    pub place: Vec4,
    /// Into which the light shines, if it is a spot.
    pub cone: Option<Cone>,
    /// Distance in metres at which it ends; directional lights have no end.
    pub range: f32,
    /// Near plane of its shadow map in metres, if not where the map puts it.
    pub near: Option<f32>,
    /// Linear RGB; 1 is white.
    pub color: [f32; 3],
    /// How bright a surface is that faces it, a metre away (of a directional light: anywhere), before
    /// `1 - exp(-x)` makes it at most 1. `None`: 2.2 at the camera's target, whatever the scale.
    pub intensity: Option<f32>,
}

impl Light {
    /// White, as bright as suits the camera. `place` is homogeneous; `range` in metres.
    pub fn new(place: Vec4, range: f32) -> Self {
        Self {
            place,
            cone: None,
            range,
            near: None,
            color: [1.0; 3],
            intensity: None,
        }
    }

    /// Which kind of light it is.
    pub fn kind(&self) -> LightKind {
        match (self.place.w == 0.0, self.cone) {
            (true, _) => LightKind::Directional,
            (false, Some(_)) => LightKind::Spot,
            (false, None) => LightKind::Point,
        }
    }
}

/// A place as the library takes it: a point in the world, or with w = 0 a direction to the light.
pub fn homogeneous(place: Vec4) -> HomogeneousLight {
    match place.w == 0.0 {
        true => HomogeneousLight::directional(place.truncate()),
        false => HomogeneousLight::point(place.truncate()),
    }
}

/// The same light from elsewhere, or from another direction.
pub fn moved_light(light: HomogeneousLight, by: Vec3) -> HomogeneousLight {
    homogeneous(light.xyzw() + by.extend(0.0))
}

/// What is where no surface is, and the light that comes from all sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Linear colour at the horizon and straight above.
    pub horizon: [f32; 3],
    pub zenith: [f32; 3],
    /// Share of full light that comes from everywhere, per colour: 0 to 1.
    pub ambient: [f32; 3],
    /// Part of what is seen that the air swallows in a metre, and replaces by the horizon's colour.
    pub haze: f32,
}

impl Default for Sky {
    /// A dark room.
    fn default() -> Self {
        Self {
            horizon: [0.012, 0.018, 0.032],
            zenith: [0.012, 0.018, 0.032],
            ambient: [0.1; 3],
            haze: 0.0,
        }
    }
}
