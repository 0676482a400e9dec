//! A light and a plane: what is drawn.

use super::axes::PlaneAxes;
use super::casters::{CastDraw, PlaneCasters};
use super::light::PlaneLight;
use super::statistics::PlanarStatistics;
use crate::Light;
use crate::scene::Casters;

/// What a light casts on a plane, kept as long as light, plane and casters are as they were.
#[derive(Debug)]
pub(crate) struct Pair {
    light: Light,
    axes: PlaneAxes,
    /// The frame of the casters that it is of.
    frame: u64,
    /// `None` where the light is behind the plane.
    pub seen: Option<PlaneLight>,
    pub draws: Vec<CastDraw>,
    /// Its part of the statistics.
    pub counts: PlanarStatistics,
}

impl Pair {
    pub fn new(light: &Light, plane: &PlaneCasters, casters: &Casters) -> Self {
        let mut counts = PlanarStatistics::default();
        let seen = PlaneLight::new(&plane.axes, light);
        let draws = match &seen {
            Some(seen) => plane.draws(casters, seen, &mut counts),
            None => {
                counts.lights_behind = 1;
                Vec::new()
            }
        };
        counts.draws = draws.len() as u32;
        counts.triangles = draws.iter().map(CastDraw::triangles).sum();
        Self {
            light: *light,
            axes: plane.axes,
            frame: casters.frame(),
            seen,
            draws,
            counts,
        }
    }

    /// Whether it is still what it was.
    pub fn is_of(&self, light: &Light, plane: &PlaneCasters, casters: &Casters) -> bool {
        self.light == *light && self.axes == plane.axes && self.frame == casters.frame()
    }
}
