//! What of the world a point light reaches: a ball as large as its range, and of a spot what of that lies in
//! its cone.
//!
//! Whatever lies elsewhere is dark under this light, shadow or none. So a caster matters only if it meets the
//! cone (rays from the apex that begin outside of a convex cone stay outside), volumes need go no farther
//! than the sides of the box around what is reached, and nothing is drawn beside what that covers on screen.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{DVec3, Vec4Swizzles as _};

use crate::volume::decide::world_box::WorldBox;
use crate::volume::frame::Situation;

/// How much wider cones are taken than they are told, in radians: more than the host's shader rounds.
const WIDER: f64 = 1e-3;

/// What a point light reaches; of a directional light everything.
#[derive(Debug)]
pub(crate) struct Reach {
    light: DVec3,
    range: Option<f64>,
    cone: Option<Cone>,
}

#[derive(Clone, Copy, Debug)]
struct Cone {
    /// Of length 1.
    axis: DVec3,
    half_angle: f64,
}

impl Reach {
    pub fn new(of: &Situation) -> Self {
        let has_place = !of.light.is_directional();
        let cone = of.cone.filter(|_| has_place).map(|cone| Cone {
            axis: cone.direction.as_dvec3().normalize(),
            half_angle: f64::from(cone.half_angle) + WIDER,
        });
        // A wider one is not convex.
        let cone = cone.filter(|cone| cone.half_angle < FRAC_PI_2);
        Self {
            light: of.light.0.xyz().as_dvec3(),
            range: of.range.filter(|_| has_place).map(f64::from),
            cone,
        }
    }

    /// Whether all of the caster, and so its shadow, lies beyond the range or beside the cone.
    pub fn misses(&self, world: &WorldBox) -> bool {
        let is_beyond = |range| world.distance(self.light) > range;
        self.range.is_some_and(is_beyond)
            || self.cone.is_some_and(|cone| self.is_beside(cone, world))
    }

    /// Of all planes that touch the cone along a line, the one on the caster's side: nothing of a ball is
    /// farther out than as seen from there.
    fn is_beside(&self, cone: Cone, world: &WorldBox) -> bool {
        let toward = world.centre() - self.light;
        let across = toward.reject_from_normalized(cone.axis);
        // What rounding leaves of a middle on the axis points anywhere.
        let across = match across.length() > 1e-6 * toward.length() {
            true => across.normalize(),
            false => cone.axis.any_orthonormal_vector(),
        };
        let (sin, cos) = cone.half_angle.sin_cos();
        let outward = cos * across - sin * cone.axis;
        world.nearest(outward) > outward.dot(self.light)
    }

    /// A ball around all of it, if that is bounded.
    pub fn ball(&self) -> Option<(DVec3, f64)> {
        let range = self.range?;
        let Some(Cone { axis, half_angle }) = self.cone else {
            return Some((self.light, range));
        };
        // Through the apex and the rim, or around the rim.
        let (sin, cos) = half_angle.sin_cos();
        let (along, radius) = match half_angle < FRAC_PI_4 {
            true => (0.5 * range / cos, 0.5 * range / cos),
            false => (range * cos, range * sin),
        };
        Some((self.light + along * axis, radius))
    }

    /// Least and greatest corner of the box around all of it, if that is bounded.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let range = self.range?;
        let far =
            [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| [-axis, axis].map(|axis| self.along(axis)));
        let of = |side: usize| DVec3::from(far.map(|both| range * both[side]));
        Some([self.light - of(0), self.light + of(1)])
    }

    /// What of a box lies in the box around it, either being endless without bounds; `None` if nothing does.
    pub fn part_of(&self, told: Option<[DVec3; 2]>) -> Option<Option<[DVec3; 2]>> {
        match (told, self.bounds()) {
            (Some([min, max]), Some([low, high])) => {
                let (min, max) = (min.max(low), max.min(high));
                min.cmple(max).all().then_some(Some([min, max]))
            }
            (one, other) => Some(one.or(other)),
        }
    }

    /// How far it goes in a direction of length 1, as a part of its range.
    fn along(&self, direction: DVec3) -> f64 {
        let Some(Cone { axis, half_angle }) = self.cone else {
            return 1.0;
        };
        let between = direction.angle_between(axis);
        // The apex itself is at 0.
        (between - half_angle).max(0.0).cos().max(0.0)
    }
}

#[cfg(test)]
#[path = "reach_tests.rs"]
mod tests;
