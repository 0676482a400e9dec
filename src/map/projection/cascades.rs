//! The maps of a directional light, each fitted to a slice of what a view shows.

use super::flat::FlatFrame;
use super::hexahedron::Hexahedron;
use super::light_box::{LightAxes, LightBox};
use super::placement::{COARSE, Cover, FINE, MapShape, Placed, Placement};
use super::slices::{Slice, box_of, box_of_sphere, hull, slices};
use crate::error::CascadeError;
use crate::map::cascades::{CascadeFit, Cascades, DepthBounds};
use crate::mesh::Bounds;
use crate::{DirectionalLight, View};

/// What cascades are fitted to.
pub(crate) struct CascadesOf<'a> {
    pub light: &'a DirectionalLight,
    pub view: &'a View,
    pub cascades: &'a Cascades,
    pub depth_bounds: Option<DepthBounds>,
    pub receivers: Option<Bounds>,
    /// Of each of the maps.
    pub shape: MapShape,
    /// What casts: [`LightBox::of_casters`].
    pub casters: Option<LightBox>,
    /// The last frame's cascades, by their index.
    pub last: &'a [Option<Placed>],
}

/// One cascade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cascade {
    pub slice: Slice,
    /// Where its map lies, and what the next frame must know of it; `None` where no shadow can be seen.
    pub map: Option<(FlatFrame, Placed)>,
}

/// A light's cascades for a view, near ones first; none where nothing casts or nothing is seen.
///
/// Each covers every point of its slice, with what kernels reach to spare, that may receive a shadow. Of
/// other points between a map's sides it says nothing unless they are 16 of its widths behind its near
/// plane: casters before that are pulled onto it.
///
/// # Errors
/// [`CascadeError`] if a map is too small for its kernels, or all together is not finite in `f32`. (Light,
/// view, cascades, depth bounds and receivers have passed their own checks.)
pub(crate) fn fit_cascades(of: &CascadesOf<'_>) -> Result<Vec<Cascade>, CascadeError> {
    let slack = slack(of)?;
    let Some(casters) = of.casters else {
        return Ok(Vec::new());
    };
    let axes = LightAxes::of(of.light);
    let placement = Placement {
        axes: &axes,
        shape: of.shape,
        casters: &casters,
    };
    let received = of
        .receivers
        .map(|bounds| LightBox::of_bounds(&axes, &bounds));
    let slices = slices(of.view, of.cascades, of.depth_bounds);
    let place = |(cascade, slice): (usize, Slice)| {
        let seen = match of.cascades.fit {
            CascadeFit::Stable => Some(box_of_sphere(of.view, &slice, &axes)),
            CascadeFit::Tight => seen_tightly(of, &slice, &axes),
        };
        let last = of.last.get(cascade).copied().flatten();
        let cover = seen.and_then(|seen| cover(of, &casters, received.as_ref(), &seen, slack));
        let map = cover.map(|cover| placement.place(&cover, last));
        match map {
            Some((frame, _)) if !frame.fits_f32() => Err(CascadeError::BeyondF32 { cascade }),
            _ => Ok(Cascade { slice, map }),
        }
    };
    slices.into_iter().enumerate().map(place).collect()
}

/// Texels by which what a cascade covers may move before the cascade does.
///
/// A quarter of a texel at least: where a camera is, and so what it sees, is not known better than
/// `f32`, and what lies just between two texels would go to and fro.
fn slack(of: &CascadesOf<'_>) -> Result<f64, CascadeError> {
    let (size, margin) = (of.shape.size, of.cascades.margin);
    let slack = (f64::from(margin) * f64::from(size)).max(0.25);
    let (reach, _) = of.shape.reach.reach();
    match 4.0 * (f64::from(reach) + 1.0 + slack) <= f64::from(size) {
        true => Ok(slack),
        false => Err(CascadeError::ReachOfSize {
            reach,
            margin,
            size,
        }),
    }
}

/// The box around what a slice shows, of what receives; `None` if that is nothing.
fn seen_tightly(of: &CascadesOf<'_>, slice: &Slice, axes: &LightAxes) -> Option<LightBox> {
    let around = box_of(of.view, slice, axes);
    let hull = hull(of.view, slice, of.depth_bounds);
    let shown = match &of.receivers {
        Some(receivers) => hull.overlap(&Hexahedron::of_bounds(receivers), axes)?,
        None => hull.around(axes),
    };
    Some(around.and(&shown))
}

/// What a cascade has to cover: what is seen, of what casts and receives. `None` if that is nothing.
///
/// The width of a stable fit goes by the size of each, and not by how much of them meets, which changes
/// as the camera walks. Where it goes by a distance, it always is the same, and need not go in coarse steps.
fn cover(
    of: &CascadesOf<'_>,
    casters: &LightBox,
    received: Option<&LightBox>,
    seen: &LightBox,
    slack: f64,
) -> Option<Cover> {
    let (_, reach) = of.shape.reach.reach();
    let reach = f64::from(reach);
    let scene = received.map_or(*casters, |received| casters.within(received, reach));
    let across = scene.within(seen, reach);
    if across.extent().min_element() < 0.0 {
        return None;
    }
    let (extent, widths) = match of.cascades.fit {
        CascadeFit::Stable => {
            let scene = scene.extent().max_element();
            let around = seen.extent().max_element() + 2.0 * reach;
            match around <= scene && of.depth_bounds.is_none() {
                true => (around, FINE),
                false => (around.min(scene), COARSE),
            }
        }
        CascadeFit::Tight => (across.extent().max_element(), COARSE),
    };
    let nearest = |received: &LightBox| received.min.z.max(seen.min.z);
    Some(Cover {
        across,
        extent,
        nearest_receiver: received.map_or(seen.min.z, nearest),
        slack,
        widths,
    })
}

#[cfg(test)]
#[path = "cascades_tests/mod.rs"]
mod tests;
