//! Axes and boxes as a directional light sees them.

use glam::{DVec2, DVec3, Vec3};

use super::flat::axes;
use crate::DirectionalLight;
use crate::mesh::Bounds;
use crate::scene::Record;

/// A directional light's right, up and forward: as shaders get them, and the same numbers in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LightAxes {
    pub rounded: [Vec3; 3],
    pub exact: [DVec3; 3],
}

impl LightAxes {
    pub fn of(light: &DirectionalLight) -> Self {
        let rounded = axes(-light.toward_light.as_dvec3());
        let exact = rounded.map(|axis| axis.as_dvec3());
        Self { rounded, exact }
    }

    /// A point of the world along the axes.
    pub fn local(&self, point: DVec3) -> DVec3 {
        DVec3::from_array(self.exact.map(|axis| axis.dot(point)))
    }
}

/// A box in a light's axes: right, up, forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightBox {
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl LightBox {
    /// The box around all casters.
    pub fn of_casters<'a>(
        light: &DirectionalLight,
        records: impl IntoIterator<Item = &'a Record>,
    ) -> Option<Self> {
        let axes = LightAxes::of(light);
        let casting = records.into_iter().filter(|record| record.casts());
        Self::around(casting.flat_map(|record| {
            let half = record.bounds.half_along(axes.exact);
            let centre = axes.local(record.bounds.centre);
            [centre - half, centre + half]
        }))
    }

    /// The box around two.
    pub fn joined(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether another one touches none of its sides from within, so that without it this one would be
    /// no smaller.
    pub fn is_held_by_others_than(&self, other: &Self) -> bool {
        other.min.cmpgt(self.min).all() && other.max.cmplt(self.max).all()
    }

    /// The box around bounds in world space.
    pub(super) fn of_bounds(axes: &LightAxes, bounds: &Bounds) -> Self {
        let [min, max] = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
        let centre = axes.local((min + max) * 0.5);
        let half = (max - min) * 0.5;
        let half = DVec3::from_array(axes.exact.map(|axis| axis.abs().dot(half)));
        let (min, max) = (centre - half, centre + half);
        Self { min, max }
    }

    /// The box around points along the axes; `None` if there are none.
    pub(super) fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points.into_iter().fold(None, |all: Option<Self>, point| {
            let (min, max) = all.map_or((point, point), |all| (all.min, all.max));
            Some(Self {
                min: min.min(point),
                max: max.max(point),
            })
        })
    }

    /// What of it lies within the sides of another one moved outward by a distance, at any depth.
    pub(super) fn within(&self, other: &Self, by: f64) -> Self {
        Self {
            min: self.min.max((other.min - by).with_z(self.min.z)),
            max: self.max.min((other.max + by).with_z(self.max.z)),
        }
    }

    /// What of it lies within another one.
    pub(super) fn and(&self, other: &Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// Its size to the right and up: below 0 if there is nothing left of it.
    pub(super) fn extent(&self) -> DVec2 {
        (self.max - self.min).truncate()
    }

    /// At least as far as rounding to `f32` moves what is in it.
    pub(super) fn rounding(&self) -> f64 {
        let farthest = self.min.abs().max(self.max.abs()).max_element();
        farthest * f64::from(f32::EPSILON)
    }
}
