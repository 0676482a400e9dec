//! Blobs, lights and views as shaders read them.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Vec4Swizzles as _};

use super::ellipsoid::Blob;
use super::frame::BlobLight;
use super::principal::to_unit_sphere;
use crate::View;

/// WGSL's `ShadowsBlob`, and an instance of decals.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct BlobRecord {
    pub row_x: [f32; 4],
    pub row_y: [f32; 4],
    pub row_z: [f32; 4],
    pub radius: f32,
    pub opacity: f32,
    pub spare: [f32; 2],
}

/// WGSL's `ShadowsBlobLight`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct LightRecord {
    pub homogeneous: [f32; 4],
    pub radius: f32,
    pub reach: f32,
    pub spare_2: [f32; 2],
    pub spare_14: [[f32; 4]; 14],
}

/// WGSL's `ShadowsBlobView`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct ViewRecord {
    pub clip_from_world: [[f32; 4]; 4],
    pub world_from_clip: [[f32; 4]; 4],
    pub origin: [f32; 4],
    pub clear_depth: f32,
    pub turn: f32,
    pub spare: [f32; 2],
    pub spare_6: [[f32; 4]; 6],
}

/// The farthest that shadows are seen, and the largest radius of what casts one: shaders square it, and `f32`
/// ends at 3e38.
pub(super) const FARTHEST: f32 = 1e16;

/// Bytes of a light or a view: what dynamic offsets are multiples of on every device.
pub(super) const STRIDE: u64 = 256;
const _: () = assert!(size_of::<LightRecord>() as u64 == STRIDE);
const _: () = assert!(size_of::<ViewRecord>() as u64 == STRIDE);

impl BlobRecord {
    /// One that casts nothing has no radius, by which shaders leave it out.
    pub fn new(blob: &Blob) -> Self {
        // Of a caster that is placed beyond `f32`.
        if !blob.is_finite() {
            return Self::default();
        }
        let Some((unit, radius)) = to_unit_sphere(blob.linear()) else {
            return Self::default();
        };
        let unit = unit.as_mat3();
        let radius = (radius as f32).next_up();
        if !unit.is_finite() || radius > FARTHEST {
            return Self::default();
        }
        let row = |axis: usize| unit.row(axis).extend(blob.centre[axis]).to_array();
        Self {
            row_x: row(0),
            row_y: row(1),
            row_z: row(2),
            radius,
            opacity: blob.opacity,
            spare: [0.0; 2],
        }
    }

    pub fn casts(&self) -> bool {
        self.radius > 0.0 && self.opacity > 0.0
    }
}

impl LightRecord {
    /// A light that nothing shadows.
    pub const NONE: Self = Self {
        homogeneous: [0.0; 4],
        radius: 0.0,
        reach: 1.0,
        spare_2: [0.0; 2],
        spare_14: [[0.0; 4]; 14],
    };

    pub fn new(light: &BlobLight) -> Self {
        let place = light.light.0;
        let toward = place.xyz().as_dvec3().normalize().as_vec3();
        let homogeneous = match light.light.is_directional() {
            true => toward.extend(0.0),
            false => place,
        };
        Self {
            homogeneous: homogeneous.to_array(),
            radius: light.radius,
            reach: light.reach.min(FARTHEST),
            ..Self::NONE
        }
    }
}

impl ViewRecord {
    /// A view that is mirrored shows front sides as back sides.
    pub fn new(view: &View) -> Self {
        let matrix = view.clip_from_world().as_dmat4();
        let corners = view.near_corners();
        let near = corners.iter().sum::<DVec3>() / 4.0;
        // In f32, as shaders add it.
        let origin = view.eye_point().unwrap_or(near).as_vec3();
        let about = matrix * DMat4::from_translation(origin.as_dvec3());
        let [right, up] = [0, 1].map(|axis| matrix.row(axis).xyz());
        let toward = view.forward().dot(right.cross(up));
        Self {
            clip_from_world: about.as_mat4().to_cols_array_2d(),
            world_from_clip: about.inverse().as_mat4().to_cols_array_2d(),
            origin: origin.extend(0.0).to_array(),
            clear_depth: view.depth().clear_depth(),
            turn: if toward > 0.0 { -1.0 } else { 1.0 },
            spare: [0.0; 2],
            spare_6: [[0.0; 4]; 6],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blob::{decals, receivers};
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn records_lie_as_the_shaders_read_them() {
        let decals = decals::source(6);
        assert_layout!(
            decals,
            "ShadowsBlob",
            BlobRecord,
            row_x,
            row_y,
            row_z,
            radius,
            opacity,
            spare
        );
        assert_layout!(
            decals,
            "ShadowsBlobView",
            ViewRecord,
            clip_from_world,
            world_from_clip,
            origin,
            clear_depth,
            turn,
            spare,
            spare_6
        );
        assert_layout!(
            receivers::source(6, 3, 0),
            "ShadowsBlobLight",
            LightRecord,
            homogeneous,
            radius,
            reach,
            spare_2,
            spare_14
        );
    }
}
