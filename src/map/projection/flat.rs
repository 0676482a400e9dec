//! Where a flat map lies in the world, and which casters it holds.

use glam::{DVec3, Mat4, Vec3};

use crate::scene::{CasterBounds, HalfSpace, Record};

/// The frame of a map: origin and axes in world space, rounded to what shaders get.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FlatFrame {
    pub origin: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// 1 / tan of the half angle, or 1 / half the width.
    pub scale: f32,
    pub near: f32,
    pub range: f32,
    pub perspective: bool,
}

/// Right, up and forward, with `right x up = forward` as on the faces of a cube map.
pub(crate) fn axes(forward: DVec3) -> [Vec3; 3] {
    let forward = forward.normalize();
    let helper = if forward.y.abs() > 0.9 {
        DVec3::Z
    } else {
        DVec3::Y
    };
    let right = helper.cross(forward).normalize();
    [right, forward.cross(right), forward].map(|axis| axis.as_vec3())
}

impl FlatFrame {
    /// Clip space from positions relative to the origin: reverse-Z, for a spot infinite.
    pub fn clip_from_light(&self) -> Mat4 {
        let across = |axis: Vec3| (axis * self.scale).extend(0.0);
        let (depth, w) = match self.perspective {
            true => (
                glam::Vec4::new(0.0, 0.0, 0.0, self.near),
                self.forward.extend(0.0),
            ),
            false => ((-self.forward / self.range).extend(1.0), glam::Vec4::W),
        };
        Mat4::from_cols(across(self.right), across(self.up), depth, w).transpose()
    }

    /// Clip space from world space.
    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_light() * Mat4::from_translation(-self.origin)
    }

    /// Whether all of it is within `f32`: not if the light or a caster is too far away, or the map
    /// too wide or too narrow.
    pub fn fits_f32(&self) -> bool {
        self.clip_from_world().is_finite() && self.range.is_finite() && self.scale.is_normal()
    }

    /// Whether the light is outside a caster's bounds and the near plane does not cut them.
    pub fn is_clear_of(&self, caster: &CasterBounds) -> bool {
        let centre = caster.relative_to(self.origin).centre;
        let forward = self.forward.as_dvec3();
        let room = caster.extent(forward, 1.0);
        !self.perspective || forward.dot(centre) - room > f64::from(self.near)
    }

    /// What lies within its sides, and its range.
    pub fn frustum(&self) -> FlatFrustum {
        let [right, up, forward] = [self.right, self.up, self.forward].map(|axis| axis.as_dvec3());
        let scale = f64::from(self.scale);
        FlatFrustum {
            origin: self.origin,
            sides: [right, -right, up, -up].map(|side| match self.perspective {
                true => HalfSpace::new(forward + scale * side, 0.0),
                false => HalfSpace::new(scale * side, 1.0),
            }),
            range: self.perspective.then_some(f64::from(self.range)),
            scale,
        }
    }
}

/// What may show on a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlatFrustum {
    origin: Vec3,
    sides: [HalfSpace; 4],
    /// Of a light with a position.
    range: Option<f64>,
    scale: f64,
}

impl FlatFrustum {
    /// Whether a caster is drawn on the map.
    pub fn holds(&self, record: &Record) -> bool {
        record.casts() && self.touches(&record.bounds)
    }

    /// Whether any point of some bounds may show.
    pub fn touches(&self, bounds: &CasterBounds) -> bool {
        let caster = bounds.relative_to(self.origin);
        // The box, too: of a caster that is scaled unevenly it may be much smaller than the sphere.
        let gap = (caster.centre.abs() - caster.half).max(DVec3::ZERO);
        let in_range = |range: f64| {
            caster.centre.length() - caster.radius <= range && gap.length_squared() <= range * range
        };
        self.sides.iter().all(|side| side.touches(&caster)) && self.range.is_none_or(in_range)
    }

    /// Whether all points of some bounds do.
    pub fn holds_all(&self, bounds: &CasterBounds) -> bool {
        let caster = bounds.relative_to(self.origin);
        let in_range = |range| caster.centre.length() + caster.radius <= range;
        self.sides.iter().all(|side| side.holds(&caster)) && self.range.is_none_or(in_range)
    }

    /// About the share of the map's area that a caster covers, up to 1.
    pub fn share(&self, caster: &CasterBounds) -> f64 {
        let distance = match self.range {
            Some(_) => caster.centre.distance(self.origin.as_dvec3()),
            None => 1.0,
        };
        (caster.radius * self.scale / distance).powi(2).min(1.0)
    }
}
