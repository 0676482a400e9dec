//! Where a flat map lies in the world: frames of spots, and frames fitted for directional lights.

use glam::{DVec2, DVec3, Mat4, Vec3};

use super::scene::Record;
use crate::mesh::Bounds;
use crate::{DirectionalLight, Radius, SpotLight, View};

/// The frame of a map: origin and axes in world space, rounded to what shaders get.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FlatFrame {
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
fn axes(forward: DVec3) -> [Vec3; 3] {
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
    pub fn of_spot(light: &SpotLight, near: f32) -> Self {
        let [right, up, forward] = axes(light.direction.as_dvec3());
        Self {
            origin: light.position,
            right,
            up,
            forward,
            scale: 1.0 / light.half_angle.tan(),
            near,
            range: light.range,
            perspective: true,
        }
    }

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
    pub fn is_clear_of(&self, record: &Record) -> bool {
        let centre = record.centre - self.origin.as_dvec3();
        let forward = self.forward.as_dvec3();
        let room = forward.abs().dot(record.half).min(record.radius);
        !self.perspective || forward.dot(centre) - room > f64::from(self.near)
    }

    /// Whether a caster is drawn on the map.
    pub fn holds(&self, record: &Record) -> bool {
        record.triangles > 0 && self.touches(record)
    }

    /// Whether a caster may show on the map.
    fn touches(&self, record: &Record) -> bool {
        let centre = record.centre - self.origin.as_dvec3();
        let [right, up, forward] = [self.right, self.up, self.forward].map(|axis| axis.as_dvec3());
        let scale = f64::from(self.scale);
        let reaches = |normal: DVec3, offset: f64| {
            let room = (normal.abs().dot(record.half)).min(record.radius * normal.length());
            normal.dot(centre) + offset + room >= 0.0
        };
        let inside = [right, -right, up, -up]
            .into_iter()
            .all(|side| match self.perspective {
                true => reaches(forward + scale * side, 0.0),
                false => reaches(scale * side, 1.0),
            });
        let range = f64::from(self.range);
        inside && (!self.perspective || centre.length() - record.radius <= range)
    }
}

/// No tap takes a receiver's plane for nearer to a directional light than the receiver by more widths
/// of the map: `bound` in flat_receiver.wgsl.
const BOUND_WIDTHS: f64 = 16.0;

/// What a directional light's map is fitted to.
pub(super) struct Fit<'a> {
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
pub(super) struct LightBox {
    min: DVec3,
    max: DVec3,
}

impl LightBox {
    /// The box around all casters.
    pub fn of_casters(light: &DirectionalLight, records: &[Record]) -> Option<Self> {
        let basis = axes(-light.toward_light.as_dvec3()).map(|axis| axis.as_dvec3());
        let local = |point: DVec3| DVec3::from_array(basis.map(|axis| axis.dot(point)));
        let casting = records.iter().filter(|record| record.triangles > 0);
        Self::of(casting.flat_map(|record| {
            let half = DVec3::from_array(basis.map(|axis| axis.abs().dot(record.half)))
                .min(DVec3::splat(record.radius));
            [local(record.centre) - half, local(record.centre) + half]
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
pub(super) fn fit(fit: &Fit<'_>) -> Option<(FlatFrame, f64)> {
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
