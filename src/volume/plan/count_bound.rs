//! How many volumes a point can be in at once: an upper bound, from the silhouettes.
//!
//! The count at a point is the number of caps between it and the light, so at most D, the number of
//! caps along the whole ray from the light through the point. As the ray turns, D changes only where
//! it crosses a side, by one for each. Turned along a meridian from one pole N to the other S it
//! crosses K sides, so it climbs from D(N) and falls to D(S) in no more than K steps, and nowhere is
//! 2 D above D(N) + D(S) + K. The largest K follows from sorting the longitudes that sides span;
//! D(N) and D(S) are 0 where the caster is between the poles, which can be had from every light
//! outside its bounds, and are counted elsewhere.
//!
//! For one caster all is in its mesh's own space: the map to the world keeps rays and what they
//! cross. Casters add up where the longitudes of their bounding spheres overlap.
//!
//! The bound is that of exact arithmetic. The rasteriser, which draws the volume of points moved by
//! their rounding, can differ from it only where that moved a side across the pixel: within the
//! rounding of a shadow's edge, where either answer is right.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3, DVec4, Vec3, Vec4Swizzles as _};

use crate::mesh::{Bounds, MeshData};
use crate::volume::decide::world_box::rounding;
use crate::volume::plan::cache::{Slot, VolumeCache};
use crate::volume::plan::params::{CasterParams, LightParams};
use crate::volume::plan::windows::Window;
use crate::volume::silhouette::CpuVolume;

/// Longitudes from and to, and how often.
type Span = ([f64; 2], u64);

/// All longitudes.
const EVERYWHERE: [f64; 2] = [-PI, PI];

/// Turns of the poles that are tried; the best is taken.
const TURNS: u32 = 4;

/// No point is in more of the volumes of these windows, all of one light, than this. What is found for
/// one volume is kept with it.
pub(crate) fn bound(
    windows: &[&Window],
    light: &LightParams,
    cache: &mut VolumeCache,
    scratch: &mut CpuVolume,
) -> u64 {
    for window in windows {
        if let Some(slot) = cache.get_mut(window.slot)
            && slot.layers.is_none()
        {
            slot.layers = Some(of_caster(slot, scratch));
        }
    }
    let casters = windows.iter();
    let casters: Vec<_> = casters
        .filter_map(|window| Some((cache.get(window.slot)?, &window.params)))
        .collect();
    let layers = |slot: &Slot| slot.layers.unwrap_or(u64::MAX);
    if casters.is_empty() {
        return 0;
    }
    let light = DVec4::from(light.homogeneous.map(f64::from));
    let axis = match light.w {
        0.0 => light.xyz().normalize(),
        _ => DVec3::X,
    };
    let together = |frame: DMat3| {
        let spans = casters.iter();
        let spans = spans.map(|(slot, caster)| (around(slot, caster, light, &frame), layers(slot)));
        deepest(spans, period(light))
    };
    frames(axis).map(together).min().unwrap_or(u64::MAX)
}

/// Turned frames with this first axis. The third points to a pole, and longitudes begin at the first;
/// those of parallel rays, along the first, are lengths along the second.
fn frames(first: DVec3) -> impl Iterator<Item = DMat3> {
    let (second, third) = first.any_orthonormal_pair();
    (0..TURNS).map(move |turn| {
        let turn = DMat3::from_axis_angle(first, PI * f64::from(turn) / f64::from(TURNS));
        DMat3::from_cols(first, turn * second, turn * third)
    })
}

/// The longitudes of a caster's bounding sphere, seen from the light.
fn around(slot: &Slot, caster: &CasterParams, light: DVec4, frame: &DMat3) -> [f64; 2] {
    let [x, y, z, w] = caster
        .world_from_object
        .map(|column| Vec3::from_slice(&column).as_dvec3());
    let linear = DMat3::from_cols(x, y, z);
    let bounds = slot.mesh.bounds();
    let centre = linear * bounds.min.as_dvec3().midpoint(bounds.max.as_dvec3()) + w;
    let reach = slot.mesh.radius_under(&linear);
    let radius = reach + rounding(centre.abs() + w.abs() + reach).length();
    if light.w == 0.0 {
        let place = frame.y_axis.dot(centre);
        return [place - radius, place + radius];
    }
    let local = frame.transpose() * (centre - light.xyz());
    let distance = local.x.hypot(local.y);
    // A little more, for a sphere that all but touches the axis of the poles.
    let sine = radius / distance * (1.0 + 1e-9);
    if sine.is_nan() || sine >= 1.0 {
        return EVERYWHERE;
    }
    let (middle, half) = (local.y.atan2(local.x), sine.asin());
    [middle - half, middle + half]
}

/// No point is in one caster's volume more often than this.
fn of_caster(slot: &Slot, scratch: &mut CpuVolume) -> u64 {
    let Some(mesh) = slot.mesh.data() else {
        // Where the positions are not known, nothing but their number is.
        return u64::from(slot.mesh.triangle_count());
    };
    let counts = scratch.extract(mesh, slot.mesh.kind(), &slot.instance);
    let caps = u64::from(counts.front / 3 + counts.back / 3);
    let [x, y, z, w] = slot.instance.light;
    let light = Vec3::new(x, y, z).as_dvec3() + Vec3::from(slot.instance.light_rest).as_dvec3();
    let seen = Seen {
        mesh,
        volume: scratch,
        light: match f64::from(w) {
            0.0 => light.extend(0.0),
            w => (light / w).extend(1.0),
        },
    };
    let found = seen.layers(slot.mesh.bounds());
    found.min(caps)
}

/// A volume seen from its light, both in the mesh's own space.
struct Seen<'a> {
    mesh: &'a MeshData,
    volume: &'a CpuVolume,
    light: DVec4,
}

impl Seen<'_> {
    fn layers(&self, bounds: Bounds) -> u64 {
        let axis = match self.light.w {
            0.0 => Some(self.light.xyz().normalize()),
            // The poles lie across it.
            _ => outward(bounds, self.light.xyz()),
        };
        let poles = |frame: &DMat3| match axis {
            Some(_) => 0,
            None => self.caps_at_poles(frame),
        };
        let most =
            |frame: DMat3| (poles(&frame) + deepest(self.sides(&frame), period(self.light))) / 2;
        let turned = frames(axis.unwrap_or(DVec3::X)).map(most);
        turned.min().unwrap_or(u64::MAX)
    }

    /// From the light to a vertex.
    fn direction(&self, vertex: u32) -> DVec3 {
        let position = Vec3::from(self.mesh.positions[vertex as usize]).as_dvec3();
        position - self.light.xyz() * self.light.w
    }

    fn longitude(&self, vertex: u32, frame: &DMat3) -> f64 {
        let local = frame.transpose() * self.direction(vertex);
        match self.light.w {
            0.0 => local.y,
            _ => local.y.atan2(local.x),
        }
    }

    fn sides<'a>(&'a self, frame: &'a DMat3) -> impl Iterator<Item = Span> + 'a {
        self.volume.sides.iter().map(move |side| {
            let [a, b, ..] = self.mesh.edges[(side >> 1) as usize];
            let ends = [a, b].map(|vertex| self.longitude(vertex, frame));
            (self.span(ends), 1)
        })
    }

    /// The shorter way from one longitude to the other.
    fn span(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        let (low, high) = (a.min(b), a.max(b));
        let width = high - low;
        if self.light.w == 0.0 || width < PI * (1.0 - 1e-9) {
            [low, high]
        } else if width > PI * (1.0 + 1e-9) {
            [high, low + TAU]
        } else {
            // Across a pole, or nearly: it may go either way.
            EVERYWHERE
        }
    }

    /// Caps that the axis of the poles runs through, or nearly.
    fn caps_at_poles(&self, frame: &DMat3) -> u64 {
        let to_frame = frame.transpose();
        let hit = |cap: &&[u32; 3]| {
            // The determinants of two corners and the pole have one sign, but for rounding.
            let corners = cap.map(|vertex| (to_frame * self.direction(vertex)).truncate());
            let turns = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| {
                let (a, b) = (corners[i], corners[j]);
                (a.perp_dot(b), 1e-12 * a.length() * b.length())
            });
            turns.iter().all(|(turn, slack)| *turn >= -slack)
                || turns.iter().all(|(turn, slack)| *turn <= *slack)
        };
        self.volume.caps(self.mesh).filter(hit).count() as u64
    }
}

/// An axis along which all of a box is on one side of a point, if the point is outside the box.
fn outward(bounds: Bounds, point: DVec3) -> Option<DVec3> {
    let below = bounds.min.as_dvec3() - point;
    let above = point - bounds.max.as_dvec3();
    let outside = below.max(above);
    let axis = outside.max_position();
    (outside[axis] > 0.0).then(|| DVec3::AXES[axis])
}

/// The largest number of spans that have a longitude in common, each without its ends; longitudes
/// repeat after `period`, in which each span begins or ends between -1/2 and 1/2.
fn deepest(spans: impl Iterator<Item = Span>, period: f64) -> u64 {
    let mut events: Vec<(f64, bool, u64)> = Vec::new();
    let mut now = 0;
    for ([from, to], times) in spans {
        if to - from >= period {
            now += times;
            continue;
        }
        if from >= to {
            continue; // along the meridian, which never crosses it
        }
        let mut push = |by: f64| events.extend([(from + by, true, times), (to + by, false, times)]);
        push(0.0);
        if to > period * 0.5 {
            push(-period);
        }
        if from < period * -0.5 {
            push(period);
        }
    }
    // What ends is counted out before what begins at the same place.
    events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut most = now;
    for (_, begins, times) in events {
        now = if begins { now + times } else { now - times };
        most = most.max(now);
    }
    most
}

/// After how much longitudes repeat.
fn period(light: DVec4) -> f64 {
    if light.w == 0.0 { f64::INFINITY } else { TAU }
}

#[cfg(test)]
#[path = "count_bound_tests.rs"]
mod tests;
