//! Maps of directional lights, fitted to what casts, receives and is seen.

use glam::{DVec2, DVec3};

use super::flat::{FlatFrame, axes};
use crate::mesh::Bounds;
use crate::scene::Record;
use crate::{DirectionalLight, Radius, View};

/// No tap takes a receiver's plane for nearer to a directional light than the receiver by more widths
/// of the map: `bound` in flat_receiver.wgsl.
const BOUND_WIDTHS: f64 = 16.0;

/// What a directional light's map is fitted to.
pub(crate) struct Fit<'a> {
    pub light: &'a DirectionalLight,
    pub view: Option<(&'a View, f32)>,
    pub receivers: Option<Bounds>,
    pub size: u32,
    pub reach: Radius,
    pub unclipped_depth: bool,
    /// Width of the last frame's map.
    pub last_width: Option<f64>,
    /// What casts: [`LightBox::of_casters`].
    pub casters: Option<LightBox>,
}

/// A box in the light's axes: right, up, forward.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightBox {
    min: DVec3,
    max: DVec3,
}

impl LightBox {
    /// The box around all casters.
    pub fn of_casters(light: &DirectionalLight, records: &[Record]) -> Option<Self> {
        let basis = axes(-light.toward_light.as_dvec3()).map(|axis| axis.as_dvec3());
        let local = |point: DVec3| DVec3::from_array(basis.map(|axis| axis.dot(point)));
        let casting = records.iter().filter(|record| record.casts());
        Self::of(casting.flat_map(|record| {
            let half = record.bounds.half_along(basis);
            let centre = local(record.bounds.centre);
            [centre - half, centre + half]
        }))
    }

    fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points.into_iter().fold(None, |all: Option<Self>, point| {
            let (min, max) = all.map_or((point, point), |all| (all.min, all.max));
            Some(Self {
                min: min.min(point),
                max: max.max(point),
            })
        })
    }
}

/// The tight frame for what casts and what is seen; `None` where no shadow can be seen. The width
/// comes with it.
///
/// Across, the map covers what casts, what receives and what is in view, all three: elsewhere there
/// is no shadow to be seen. Widths go in steps of a quarter octave, and the last one stays while it
/// is no more than a step too wide; the grid of texels is fixed in the world (Valient, "Stable
/// Rendering of Cascaded Shadow Maps", ShaderX6, 2008). So shadows do not shimmer when the camera
/// moves or turns.
pub(crate) fn fit_directional(fit: &Fit<'_>) -> Option<(FlatFrame, f64)> {
    let rounded = axes(-fit.light.toward_light.as_dvec3());
    let basis = rounded.map(|axis| axis.as_dvec3());
    let local = |point: DVec3| DVec3::from_array(basis.map(|axis| axis.dot(point)));
    let casters = fit.casters?;
    let mut across = casters;
    let mut nearest_receiver = f64::NEG_INFINITY;
    let seen = fit
        .view
        .map(|(view, distance)| shown(view, f64::from(distance)));
    let received = fit.receivers.map(|bounds| corners(&bounds));
    let (reach_texels, reach_world) = fit.reach.reach();
    for points in [seen, received].into_iter().flatten() {
        let bounds = LightBox::of(points.into_iter().map(local))?;
        across.min = across.min.max(bounds.min - f64::from(reach_world));
        across.max = across.max.min(bounds.max + f64::from(reach_world));
        nearest_receiver = nearest_receiver.max(bounds.min.z);
    }
    let extent = (across.max - across.min).truncate();
    if extent.min_element() < 0.0 {
        return None;
    }
    // Texels on either side: one for the snap and the tap's own texel, and what kernels reach. No more
    // than half of the map, see `validate_reach`.
    let share = 2.0 * (f64::from(reach_texels) + 1.0) / f64::from(fit.size);
    // The frame's origin is rounded, too.
    let rounding = rounding(&across).max(rounding(&casters));
    let need = extent.max_element().max(least_extent(&across, fit.size)) + 2.0 * rounding;
    let need = need / (1.0 - share);
    let step = (need.log2() * 4.0).ceil() / 4.0;
    let width = match fit.last_width {
        Some(last) if last >= need && last <= (step + 0.26).exp2() => last,
        _ => step.exp2(),
    };
    let texel = width / f64::from(fit.size);
    let middle = (across.min + across.max).truncate() * 0.5;
    let centre: DVec2 = (middle / texel).round() * texel;
    // Casters so far before every receiver that no tap takes a receiver's plane for as near are pulled
    // onto the near plane where the device can: there they are before every plane still.
    let margin = (2.0 * texel).max(rounding);
    let near = match fit.unclipped_depth {
        true => casters
            .min
            .z
            .max((nearest_receiver - BOUND_WIDTHS * width).min(casters.max.z)),
        false => casters.min.z,
    } - margin;
    let [right, up, forward] = basis;
    let origin = right * centre.x + up * centre.y + forward * near;
    let frame = FlatFrame {
        origin: origin.as_vec3(),
        right: rounded[0],
        up: rounded[1],
        forward: rounded[2],
        scale: (2.0 / width) as f32,
        near: 0.0,
        range: (casters.max.z + margin - near) as f32,
        perspective: false,
    };
    Some((frame, width))
}

/// The least that a map can be wide: what `f32` tells apart where it lies, and so much at the origin
/// that one over a texel is finite.
fn least_extent(covered: &LightBox, size: u32) -> f64 {
    let least = f64::from(f32::MIN_POSITIVE) * f64::from(size);
    rounding(covered).max(least)
}

/// At least as far as rounding to `f32` moves what is in a box.
fn rounding(covered: &LightBox) -> f64 {
    let farthest = covered.min.abs().max(covered.max.abs()).max_element();
    farthest * f64::from(f32::EPSILON)
}

/// Corners of what a view shows: in perspective up to a distance from the eye along its axis.
fn shown(view: &View, distance: f64) -> [DVec3; 8] {
    let (near, far) = (view.near_corners(), view.far_corners());
    let end: [DVec3; 4] = match view.eye_point() {
        None => far.unwrap_or(near),
        Some(eye) => {
            let forward = view.forward().normalize();
            let depth = |point: DVec3| forward.dot(point - eye);
            let lines = view.sight_lines().map(|line| line / forward.dot(line));
            std::array::from_fn(|corner| {
                let last = far.map_or(distance, |far| distance.min(depth(far[corner])));
                eye + lines[corner] * last.max(depth(near[corner]))
            })
        }
    };
    let [a, b, c, d] = near;
    let [e, f, g, h] = end;
    [a, b, c, d, e, f, g, h]
}

fn corners(bounds: &Bounds) -> [DVec3; 8] {
    let ends = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
    std::array::from_fn(|i| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2 & 1].z))
}
