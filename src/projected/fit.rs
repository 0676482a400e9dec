//! Where a shadow's tile lies in the world: a square around what casts, as the light sees it.

use glam::{DVec3, Vec3};

use super::statistics::ProjectorState;
use crate::map::{FlatFrame, axes, fit_spot};
use crate::scene::CasterBounds;
use crate::{Caster, DirectionalLight, Light, SpotLight};

/// The widest square: the tangent of the angle to each side, 84 degrees.
const WIDEST: f64 = 10.0;

/// Texels of the tile beside what casts, on each side, so that its outline is blended into light within
/// the tile.
const MARGIN: f64 = 1.0;

/// Rounding of what `f32` holds, as a part of it.
const ROUNDING: f64 = f32::EPSILON as f64;

/// The frame of a tile of so many texels along a side, around casters in range; its `near` is the distance along the light's direction at
/// which the nearest caster begins.
pub(super) fn fit(
    light: &Light,
    casters: &[CasterBounds],
    size: u32,
) -> Result<FlatFrame, ProjectorState> {
    let frame = match light {
        Light::Point(light) => around(light.position, light.range, casters, size)?,
        Light::Spot(light) => fit_cone(light, casters, size)?,
        Light::Directional(light) => fit_parallel(light, casters, size)?,
    };
    let fits = frame.fits_f32() && frame.near.is_finite();
    fits.then_some(frame).ok_or(ProjectorState::BeyondF32)
}

/// The bounds of a caster that has a shadow within the light's range; `None` if it is empty or beyond. What is beyond
/// would darken, in a tile's picture, which knows no depth, what lies before it.
pub(super) fn casting_bounds(light: &Light, caster: &Caster) -> Option<CasterBounds> {
    let bounds = (caster.mesh.triangle_count() > 0).then(|| CasterBounds::of(caster))?;
    is_in_range(light, &bounds).then_some(bounds)
}

/// Whether any of a caster may be within a light's range.
fn is_in_range(light: &Light, caster: &CasterBounds) -> bool {
    let (position, range) = match light {
        Light::Point(light) => (light.position, light.range),
        Light::Spot(light) => (light.position, light.range),
        Light::Directional(_) => return true,
    };
    let (apart, range) = (caster.centre - position.as_dvec3(), f64::from(range));
    let to_box = (apart.abs() - caster.half).max(DVec3::ZERO).length();
    to_box <= range && apart.length() - caster.radius <= range
}

/// The smaller of the squares around a spot's cone and around the casters in range that it reaches.
fn fit_cone(
    light: &SpotLight,
    casters: &[CasterBounds],
    size: u32,
) -> Result<FlatFrame, ProjectorState> {
    // Far less than any caster's distance that can be told from 0; only positions decide.
    let least = (light.range * 0.5 * f32::EPSILON).max(f32::MIN_POSITIVE);
    let cone = fit_spot(light, least);
    let frustum = cone.frustum();
    let reached = casters.iter().filter(|caster| frustum.touches(caster));
    let reached: Vec<CasterBounds> = reached.copied().collect();
    match around(light.position, light.range, &reached, size) {
        Ok(frame) if frame.scale > cone.scale => Ok(frame),
        Err(ProjectorState::Empty) => Err(ProjectorState::Empty),
        _ => Ok(FlatFrame {
            near: (begin(&cone, &reached) as f32).max(least),
            ..cone
        }),
    }
}

/// A square pyramid from a point around casters in range.
fn around(
    position: Vec3,
    range: f32,
    casters: &[CasterBounds],
    size: u32,
) -> Result<FlatFrame, ProjectorState> {
    let casters: Vec<CasterBounds> = casters
        .iter()
        .map(|caster| caster.relative_to(position))
        .collect();
    let toward = middle(&casters).ok_or(ProjectorState::Empty)?;
    let forward = toward.try_normalize().ok_or(ProjectorState::Surrounded)?;
    let [right, up, forward] = axes(forward);
    let across = [right, up].map(|axis| axis.as_dvec3());
    let mut half: f64 = 0.0;
    for caster in &casters {
        for axis in across {
            half = half.max(slope(caster, axis, forward.as_dvec3())?);
        }
    }
    if half > WIDEST {
        return Err(ProjectorState::Surrounded);
    }
    let mut frame = FlatFrame {
        origin: position,
        right,
        up,
        forward,
        scale: scale(half.max(ROUNDING), size),
        near: 0.0,
        range,
        perspective: true,
    };
    let near = begin_of(&frame, &casters);
    // As f32 it is at least the least normal number: the casters are all before the light.
    frame.near = (near as f32).max(f32::MIN_POSITIVE);
    Ok(frame)
}

/// A square along parallel rays.
fn fit_parallel(
    light: &DirectionalLight,
    casters: &[CasterBounds],
    size: u32,
) -> Result<FlatFrame, ProjectorState> {
    let middle = middle(casters).ok_or(ProjectorState::Empty)?;
    let [right, up, forward] = axes(-light.toward_light.as_dvec3());
    let origin = middle.as_vec3();
    let mut frame = FlatFrame {
        origin,
        right,
        up,
        forward,
        scale: 0.0,
        near: 0.0,
        range: 0.0,
        perspective: false,
    };
    let relative = casters.iter().map(|caster| caster.relative_to(origin));
    let relative: Vec<CasterBounds> = relative.collect();
    let exact = [right, up, forward].map(|axis| axis.as_dvec3());
    let farthest = |axis: DVec3| {
        let far = |caster: &CasterBounds| axis.dot(caster.centre).abs() + caster.extent(axis, 1.0);
        relative.iter().map(far).fold(0.0, f64::max)
    };
    let [half, deep] = [
        farthest(exact[0]).max(farthest(exact[1])),
        farthest(exact[2]),
    ];
    let rounding = middle.abs().max_element() * ROUNDING;
    frame.scale = scale(half.max(rounding), size);
    frame.near = begin_of(&frame, &relative) as f32;
    frame.range = deep.max(rounding) as f32;
    Ok(frame)
}

/// One over half a square's width, with the margin.
fn scale(half: f64, size: u32) -> f32 {
    ((1.0 - 2.0 * MARGIN / f64::from(size)) / half) as f32
}

/// The middle of the box around all casters.
fn middle(casters: &[CasterBounds]) -> Option<DVec3> {
    let corners = casters.iter().map(|caster| {
        let half = caster.half.min(DVec3::splat(caster.radius));
        (caster.centre - half, caster.centre + half)
    });
    let (min, max) = corners.reduce(|all, one| (all.0.min(one.0), all.1.max(one.1)))?;
    Some((min + max) * 0.5)
}

/// How far from a point a caster reaches along an axis, as a part of its distance forward: by its sphere, or
/// by its box, whichever says less.
fn slope(caster: &CasterBounds, axis: DVec3, forward: DVec3) -> Result<f64, ProjectorState> {
    let (along, ahead) = (axis.dot(caster.centre).abs(), forward.dot(caster.centre));
    let nearest = ahead - caster.extent(forward, 1.0);
    if nearest <= 0.0 {
        return Err(ProjectorState::Surrounded);
    }
    let box_slope = (along + caster.extent(axis, 1.0)) / nearest;
    let distance = along.hypot(ahead);
    let angle = along.atan2(ahead) + (caster.radius / distance).min(1.0).asin();
    match angle < std::f64::consts::FRAC_PI_2 {
        true => Ok(angle.tan().min(box_slope)),
        false => Ok(box_slope),
    }
}

/// Where the nearest caster begins, along the frame's forward axis from its origin.
fn begin(frame: &FlatFrame, casters: &[CasterBounds]) -> f64 {
    let relative = casters
        .iter()
        .map(|caster| caster.relative_to(frame.origin));
    begin_of(frame, &relative.collect::<Vec<_>>())
}

/// The same of casters relative to that origin.
fn begin_of(frame: &FlatFrame, casters: &[CasterBounds]) -> f64 {
    let forward = frame.forward.as_dvec3();
    let nearest = |caster: &CasterBounds| {
        forward.dot(caster.centre) - caster.extent(forward, forward.length())
    };
    casters.iter().map(nearest).fold(f64::INFINITY, f64::min)
}
