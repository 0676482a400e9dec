//! Maps of spots.

use super::flat::{FlatFrame, axes};
use crate::SpotLight;

/// The frame of a spot's map: around its cone.
pub(crate) fn fit_spot(light: &SpotLight, near: f32) -> FlatFrame {
    let [right, up, forward] = axes(light.direction.as_dvec3());
    FlatFrame {
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
