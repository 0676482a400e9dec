//! A reference picture: what each pixel sees and whether the light reaches it.

use crate::clock::Clock;
use std::collections::HashMap;
use std::sync::Mutex;

use glam::{DVec3, DVec4, Vec4Swizzles};
use rayon::prelude::*;

use super::camera::{Camera, PixelRay};
use super::geometry::{Geometry, SurfacePoint};
use crate::error::{LightError, ReferenceError};
use crate::{HomogeneousLight, SpotLight};

/// What a pixel of the reference shows. Exhaustive: every pixel belongs to one class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// No surface.
    Background,
    /// The side of a triangle that faces away from the light, or is edge-on to it.
    Away,
    /// A side that faces the light but is beyond its range or outside a spot's cone.
    OutOfRange,
    /// A side that faces the light, with nothing in between.
    Lit,
    /// A side that faces the light, behind a caster.
    Shadowed,
}

impl Class {
    /// Whether shadow techniques are judged here, because the surface faces the light within range.
    pub fn faces_light(self) -> bool {
        matches!(self, Self::Lit | Self::Shadowed)
    }
}

/// The first thing that the ray through a pixel's centre hits.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit {
    /// Index in the list passed to [`ReferenceScene::new`](super::ReferenceScene::new).
    pub object: u32,
    /// Triangle of that object, in the order of its indices.
    pub triangle: u32,
    /// World space.
    pub position: DVec3,
    /// Unit normal of the triangle, world space, toward the viewer.
    pub normal: DVec3,
    /// Distance from the near plane along the pixel's ray, in world units.
    pub distance: f64,
}

/// The light as the reference takes it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lighting {
    pub(super) light: DVec4,
    range: f64,
    /// Unit direction of a spot, and the cosine of its half angle.
    cone: Option<(DVec3, f64)>,
}

impl Lighting {
    /// As [`new`](Self::new), of numbers that make sense.
    pub(super) fn checked(
        light: HomogeneousLight,
        range: Option<f32>,
    ) -> Result<Self, ReferenceError> {
        light.validate()?;
        if let Some(range) = range.filter(|range| !(range.is_finite() && *range > 0.0)) {
            return Err(LightError::Range(range).into());
        }
        Ok(Self::new(light, range))
    }

    pub(super) fn new(light: HomogeneousLight, range: Option<f32>) -> Self {
        let range = match range {
            Some(range) if !light.is_directional() => f64::from(range),
            _ => f64::INFINITY,
        };
        Self {
            light: light.0.as_dvec4(),
            range,
            cone: None,
        }
    }

    pub(super) fn of_spot(spot: &SpotLight) -> Self {
        let direction = spot.direction.as_dvec3().normalize();
        Self {
            cone: Some((direction, f64::from(spot.half_angle).cos())),
            ..Self::new(spot.homogeneous(), Some(spot.range))
        }
    }

    /// The light elsewhere, for points that it reaches: without its range and its cone.
    pub(super) fn moved_to(light: DVec4) -> Self {
        Self {
            light,
            range: f64::INFINITY,
            cone: None,
        }
    }

    /// Whether there is any of the light at a place, shadows aside.
    pub(super) fn reaches(&self, position: DVec3) -> bool {
        let along = position - self.light.xyz();
        let inside = |(axis, cosine): (DVec3, f64)| axis.dot(along) >= cosine * along.length();
        self.light.w == 0.0 || (along.length() <= self.range && self.cone.is_none_or(inside))
    }

    /// The class of a point seen on the side of its triangle that `side` (+1 or -1) names.
    pub(super) fn class(&self, geometry: &Geometry, surface: &SurfacePoint, side: f64) -> Class {
        let light = self.light;
        if geometry.triangle(surface.triangle).light_side(light) * side <= 0.0 {
            Class::Away
        } else if !self.reaches(surface.position) {
            Class::OutOfRange
        } else if geometry.blocked(surface, light) {
            Class::Shadowed
        } else {
            Class::Lit
        }
    }
}

/// A pixel's class, its triangle and how far along its ray that is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixel {
    pub(super) class: Class,
    triangle: u32,
    distance: f64,
}

impl Pixel {
    pub(super) fn cast(geometry: &Geometry, lighting: &Lighting, ray: &PixelRay) -> Self {
        let mut pixel = Self {
            class: Class::Background,
            triangle: u32::MAX,
            distance: f64::INFINITY,
        };
        if let Some((triangle, distance)) = geometry.nearest(ray.origin, ray.direction, ray.end) {
            (pixel.triangle, pixel.distance) = (triangle, distance);
            let seen = Seen::new(geometry, ray, &pixel);
            pixel.class = lighting.class(geometry, &seen.surface, seen.side);
        }
        pixel
    }
}

/// A pixel's surface in world space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) ray: PixelRay,
    pub(super) surface: SurfacePoint,
    /// +1 if the viewer sees the triangle's corners counter-clockwise, else -1.
    pub(super) side: f64,
    /// Unit normal toward the viewer.
    pub(super) normal: DVec3,
}

impl Seen {
    fn new(geometry: &Geometry, ray: &PixelRay, pixel: &Pixel) -> Self {
        let normal = geometry.triangle(pixel.triangle).normal().normalize();
        let side = -normal.dot(ray.direction).signum();
        let position = ray.at(pixel.distance);
        let size = ray.origin.abs().max(position.abs()).max_element();
        Self {
            ray: *ray,
            surface: SurfacePoint {
                position,
                triangle: pixel.triangle,
                size,
            },
            side,
            normal: normal * side,
        }
    }
}

/// Whether a pixel is in the interior, by radius (a hash) and number.
pub(super) type InteriorCache = Mutex<HashMap<(u64, usize), bool>>;

/// The exact answer for one view and one light, from
/// [`ReferenceScene::render`](super::ReferenceScene::render).
///
/// Lists of pixels are row-major from the top left.
pub struct ReferenceImage {
    pub(super) geometry: Geometry,
    pub(super) camera: Camera,
    pub(super) lighting: Lighting,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) pixels: Vec<Pixel>,
    pub(super) seconds: f64,
    pub(super) interiors: InteriorCache,
}

impl ReferenceImage {
    /// The same picture under another light: what each pixel sees is known, so only rays to the light are
    /// cast. `range` as in [`ReferenceScene::render`](super::ReferenceScene::render).
    ///
    /// # Errors
    /// [`ReferenceError`] if the light or the range is not valid.
    pub fn relit(
        &self,
        light: HomogeneousLight,
        range: Option<f32>,
    ) -> Result<Self, ReferenceError> {
        Ok(self.lit_by(Lighting::checked(light, range)?))
    }

    /// The same picture under a spot.
    ///
    /// # Errors
    /// [`ReferenceError`] if the light is not valid.
    pub fn relit_by_spot(&self, light: &SpotLight) -> Result<Self, ReferenceError> {
        light.validate()?;
        Ok(self.lit_by(Lighting::of_spot(light)))
    }

    fn lit_by(&self, lighting: Lighting) -> Self {
        let start = Clock::start();
        let relit = |number: usize| {
            let [x, y] = [number as u32 % self.width, number as u32 / self.width];
            let class = match self.seen(x, y) {
                Some(seen) => lighting.class(&self.geometry, &seen.surface, seen.side),
                None => Class::Background,
            };
            Pixel {
                class,
                ..self.pixels[number]
            }
        };
        Self {
            geometry: self.geometry.clone(),
            camera: self.camera,
            lighting,
            width: self.width,
            height: self.height,
            pixels: (0..self.pixels.len()).into_par_iter().map(relit).collect(),
            seconds: start.elapsed().as_secs_f64(),
            interiors: Default::default(),
        }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Wall-clock seconds that the picture took; 0 in a browser, where the standard library has no clock.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// The class of each pixel.
    pub fn classes(&self) -> impl ExactSizeIterator<Item = Class> + '_ {
        self.pixels.iter().map(|pixel| pixel.class)
    }

    /// The number of pixels of one class.
    pub fn count(&self, class: Class) -> usize {
        self.classes().filter(|&other| other == class).count()
    }

    /// The number of pixels on which techniques are judged: [`Class::Lit`] and
    /// [`Class::Shadowed`].
    pub fn lit_facing(&self) -> usize {
        self.classes().filter(|class| class.faces_light()).count()
    }

    /// What a pixel shows; `None` for the background, and outside the picture.
    pub fn hit(&self, x: u32, y: u32) -> Option<Hit> {
        let seen = self.seen(x, y)?;
        let [object, triangle] = self.geometry.triangle(seen.surface.triangle).source;
        Some(Hit {
            object,
            triangle,
            position: seen.surface.position,
            normal: seen.normal,
            distance: self.pixels[self.number(x, y)].distance,
        })
    }

    /// One byte per pixel: 255 where the light arrives, 0 in shadow, where the surface faces away or
    /// is out of range, and in the background.
    pub fn visibility(&self) -> Vec<u8> {
        self.classes()
            .map(|class| if class == Class::Lit { 255 } else { 0 })
            .collect()
    }

    /// One byte per pixel: 255 where a surface faces the light within range, lit or not, 128 where
    /// it faces away or is out of range, 0 in the background.
    pub fn coverage(&self) -> Vec<u8> {
        self.classes()
            .map(|class| match class {
                Class::Background => 0,
                Class::Away | Class::OutOfRange => 128,
                Class::Lit | Class::Shadowed => 255,
            })
            .collect()
    }

    /// The row-major number of a pixel inside the picture.
    pub(super) fn number(&self, x: u32, y: u32) -> usize {
        y as usize * self.width as usize + x as usize
    }

    pub(super) fn class(&self, x: u32, y: u32) -> Class {
        self.pixels[self.number(x, y)].class
    }

    pub(super) fn seen(&self, x: u32, y: u32) -> Option<Seen> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let pixel = &self.pixels[self.number(x, y)];
        (pixel.class != Class::Background)
            .then(|| Seen::new(&self.geometry, &self.camera.ray(x, y), pixel))
    }
}
