//! The one map of a directional light, fitted to what casts, receives and is seen.

use glam::DVec3;

use super::flat::FlatFrame;
use super::light_box::{LightAxes, LightBox};
use super::placement::{COARSE, Cover, MapShape, Placed, Placement};
use crate::mesh::Bounds;
use crate::{DirectionalLight, View};

/// What a directional light's map is fitted to.
pub(crate) struct Fit<'a> {
    pub light: &'a DirectionalLight,
    pub view: Option<(&'a View, f32)>,
    pub receivers: Option<Bounds>,
    pub shape: MapShape,
    /// What casts: [`LightBox::of_casters`].
    pub casters: Option<LightBox>,
    /// Where the last frame's map was.
    pub last: Option<Placed>,
}

/// The tight frame for what casts and what is seen; `None` where no shadow can be seen.
///
/// Across, the map covers what casts, what receives and what is in view, all three: elsewhere there
/// is no shadow to be seen.
pub(crate) fn fit_directional(fit: &Fit<'_>) -> Option<(FlatFrame, Placed)> {
    let axes = LightAxes::of(fit.light);
    let casters = fit.casters?;
    let (_, reach_world) = fit.shape.reach.reach();
    let received = fit
        .receivers
        .map(|bounds| LightBox::of_bounds(&axes, &bounds));
    let seen = fit.view.and_then(|(view, distance)| {
        let corners = shown(view, f64::from(distance));
        LightBox::around(corners.map(|corner| axes.local(corner)))
    });
    let mut across = casters;
    let mut nearest_receiver = f64::NEG_INFINITY;
    for bounds in [seen, received].into_iter().flatten() {
        across = across.within(&bounds, f64::from(reach_world));
        nearest_receiver = nearest_receiver.max(bounds.min.z);
    }
    let extent = across.extent();
    if extent.min_element() < 0.0 {
        return None;
    }
    let cover = Cover {
        across,
        extent: extent.max_element(),
        nearest_receiver,
        slack: 0.0,
        widths: COARSE,
    };
    let placement = Placement {
        axes: &axes,
        shape: fit.shape,
        casters: &casters,
    };
    Some(placement.place(&cover, fit.last))
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
