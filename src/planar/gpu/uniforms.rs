//! What shaders are told of planes, lights and views.

use glam::{DVec3, DVec4, Mat4};

use crate::planar::axes::PlaneAxes;
use crate::planar::light::PlaneLight;

/// `ShadowsPlanarUniform` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct PlanarUniform {
    clip_from_plane: [[f32; 4]; 3],
    slope: [f32; 4],
    shade: [f32; 4],
    place: [f32; 4],
    cone: [f32; 4],
}

impl PlanarUniform {
    pub fn new(
        clip_from_world: &Mat4,
        axes: &PlaneAxes,
        light: &PlaneLight,
        shade: [f32; 3],
    ) -> Self {
        let rows = [0, 1, 2, 3].map(|row| clip_from_world.row(row).as_dvec4());
        Self::of_rows(&rows, axes, light, shade)
    }

    /// The same for a matrix by its rows, in f64.
    pub fn of_rows(
        rows: &[DVec4; 4],
        axes: &PlaneAxes,
        light: &PlaneLight,
        shade: [f32; 3],
    ) -> Self {
        let [red, green, blue] = shade;
        let narrow = |vector: DVec3, w: f64| vector.extend(w).as_vec4().to_array();
        let (axis, cosine) = light.cone.unwrap_or((DVec3::ZERO, -1.0));
        let slope = light.slope.extend(light.inverse_height());
        let place = light.place.unwrap_or_default();
        Self {
            clip_from_plane: clip_from_plane(rows, axes),
            slope: narrow(slope, 0.0),
            shade: [red, green, blue, 1.0],
            place: narrow(place, light.inverse_range()),
            cone: narrow(axis, cosine),
        }
    }
}

/// What x, y and 1 of a point of the plane come to in clip space.
fn clip_from_plane(rows: &[DVec4; 4], axes: &PlaneAxes) -> [[f32; 4]; 3] {
    let [x, y] = axes.along;
    let columns = [x.extend(0.0), y.extend(0.0), axes.origin.extend(1.0)];
    columns.map(|column| rows.map(|row| row.dot(column) as f32))
}

#[cfg(test)]
mod tests {
    use super::PlanarUniform;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_shader_has_the_same_layout() {
        assert_layout!(
            crate::wgsl::PLANAR_CASTER,
            "ShadowsPlanarUniform",
            PlanarUniform,
            clip_from_plane,
            slope,
            shade,
            place,
            cone,
        );
    }
}
