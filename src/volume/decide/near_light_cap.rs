//! The way into a caster from a light that may be very near to it.

use glam::{DAffine3, DVec3};

use crate::HomogeneousLight;
use crate::mesh::Bounds;
use crate::volume::decide::method::{DarkCap, Form};
use crate::volume::decide::world_box::WorldBox;

/// Share of a caster's depth, seen along the axis of its fan, that must lie between it and the
/// light for the axis to be a good one.
const CLEAR: f64 = 0.1;

/// Chooses the dark cap of a volume without end anew where the light is nearer to the caster than
/// f32 and boxes in world space can tell.
///
/// From a point just above a large triangle its corners lie along the horizon, almost in one plane
/// with the light. A far triangle between them covers half the sky, but as homogeneous coordinates
/// it is nearly singular, and what clipping makes of it is anything. A fan around the direction
/// straight into the caster has no such triangle. It is right wherever all of the caster is on one
/// side of the light, which its own box says to the last bit.
pub(crate) fn settle(
    form: &mut Form,
    (bounds, map): (Bounds, &DAffine3),
    light: HomogeneousLight,
    world: &WorldBox,
) {
    if light.is_directional() || !form.far.is_infinite() || form.dark_cap == DarkCap::None {
        return;
    }
    let axis = form.far.apex.truncate();
    let from_light = axis.dot(light.0.truncate().as_dvec3());
    let nearest = world.nearest(axis) - from_light;
    let farthest = world.farthest(axis) - from_light;
    if form.dark_cap == DarkCap::Fan && nearest > CLEAR * farthest {
        return;
    }
    if let Some(inward) = inward(bounds, map, light.0.truncate().as_dvec3()) {
        form.dark_cap = DarkCap::Fan;
        form.far.apex = inward.extend(0.0);
    }
}

/// The direction, in world space and of length 1, across the side of a mesh's turned box that is
/// farthest from a point outside of it; `None` inside. All of it in world space, so that the box may be
/// flat.
fn inward(bounds: Bounds, map: &DAffine3, point: DVec3) -> Option<DVec3> {
    // Normals go over to the world by the cofactors, of which the sign is that of the mirror.
    let m = map.matrix3;
    let mirror = m.determinant().signum();
    let normals = [
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    ];
    let [from_min, from_max] =
        [bounds.min, bounds.max].map(|corner| point - map.transform_point3(corner.as_dvec3()));
    let sides = normals.into_iter().flat_map(|normal| {
        let inward = (normal * mirror).normalize_or_zero();
        [
            (-inward.dot(from_min), inward),
            (inward.dot(from_max), -inward),
        ]
    });
    sides
        .filter(|(distance, _)| *distance > 0.0)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, normal)| normal)
}
