//! What has to be decided for a caster before its volume can be extracted. All in f64.

use glam::{DAffine3, DVec3, DVec4, Vec3, Vec4Swizzles as _};

use super::world_box::WorldBox;
use super::{ShadowVolumeFrame, StartFrom};
use crate::error::CasterError;
use crate::mesh::MeshKind;
use crate::{Caster, DepthConvention, HomogeneousLight, View};

/// Which triangles of a mesh count; as the shaders have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Counted {
    /// Those facing the light.
    LightFacing = 0,
    /// All, turned toward the light.
    All = 1,
    /// Those turned away from the light, turned over.
    AwayFacing = 2,
}

impl Counted {
    pub fn of(
        caster: &Caster,
        world: &WorldBox,
        frame: &ShadowVolumeFrame<'_>,
        start: StartFrom,
    ) -> Self {
        match start {
            _ if counts_both_sides(caster, world, frame.light, frame.view) => Self::All,
            // Inside out, the triangles turned away would be those that the light reaches. Where only
            // the GPU knows the positions, the host is believed.
            StartFrom::AwayFacing if caster.mesh.is_solid() || caster.mesh.data().is_none() => {
                Self::AwayFacing
            }
            StartFrom::LightFacing | StartFrom::AwayFacing => Self::LightFacing,
        }
    }
}

/// Whether every triangle has to count, turned toward the light, or the light-facing ones suffice.
///
/// They, or those turned away alone, suffice for a closed, consistently wound mesh if the light and
/// the near rectangle are both outside it. Proof: along the segment from a visible point P to the
/// light L, let f triangles be crossed that face the light and b that do not. A crossing changes the
/// mesh's winding number by one, in opposite directions for the two kinds, so
/// w(P) - w(L) = ±(f - b). L is outside: w(L) = 0.
/// The sight line from the near rectangle to P crosses no surface (P is what is visible), so w(P)
/// is that of the near rectangle, 0. Hence f = b, and both are above 0 exactly if
/// anything is crossed at all.
/// With L or the eye inside, f and b differ, and f = 0 may go with b > 0.
fn counts_both_sides(
    caster: &Caster,
    world: &WorldBox,
    light: HomogeneousLight,
    view: &View,
) -> bool {
    if caster.mesh.kind() == MeshKind::General {
        return true;
    }
    let (near, radius) = view.near_sphere();
    // The near rectangle stems from a matrix of f32, too.
    let radius = radius * (1.0 + 8.0 * f64::from(f32::EPSILON));
    !(world.excludes(light) && world.distance(near) > radius)
}

/// The light in a mesh's own space, in two f32 that add up to it.
pub(super) struct ObjectLight {
    pub light: [f32; 4],
    pub rest: [f32; 3],
}

impl ObjectLight {
    pub fn new(light: HomogeneousLight, map: &DAffine3, index: usize) -> Result<Self, CasterError> {
        let singular = CasterError::Singular { index };
        if map.matrix3.determinant() == 0.0 {
            return Err(singular);
        }
        let inverse = map.inverse();
        let exact = if light.is_directional() {
            unit_exponent(inverse.transform_vector3(light.0.xyz().as_dvec3()))
        } else {
            inverse.transform_point3(light.0.xyz().as_dvec3())
        };
        let rounded = exact.as_vec3();
        if !rounded.is_finite() {
            return Err(singular);
        }
        let rest = (exact - rounded.as_dvec3()).as_vec3();
        Ok(Self {
            light: rounded.extend(light.0.w).to_array(),
            rest: rest.to_array(),
        })
    }

    /// The sum of the two.
    pub fn exact(&self) -> DVec3 {
        let [x, y, z, _] = self.light;
        Vec3::new(x, y, z).as_dvec3() + Vec3::from(self.rest).as_dvec3()
    }
}

/// A direction scaled by a power of two (so exactly) to a largest component between 1 and 2.
fn unit_exponent(direction: DVec3) -> DVec3 {
    direction * (-direction.abs().max_element().log2().floor()).exp2()
}

/// The light as the draws take it: a direction of any length, without the risk of overflow.
pub(super) fn world_light(light: HomogeneousLight) -> [f32; 4] {
    if light.is_directional() {
        let direction: Vec3 = unit_exponent(light.0.xyz().as_dvec3()).as_vec3();
        return direction.extend(0.0).to_array();
    }
    light.0.to_array()
}

/// Whether a triangle whose normal (b - a) x (c - a) points to the viewer is clockwise on screen.
///
/// Its signed area on screen has the sign of normal . (eye - w a), with the homogeneous eye that is
/// the generalised cross product of the matrix's x, y and w rows.
pub(super) fn is_left_handed(view: &View) -> bool {
    let eye: DVec4 = view.eye();
    if eye.w != 0.0 {
        return eye.w < 0.0;
    }
    let deeper = view.clip_from_world().row(2).xyz().as_dvec3();
    let to_viewer = match view.depth() {
        DepthConvention::Standard => -deeper,
        DepthConvention::FiniteReverse | DepthConvention::InfiniteReverse => deeper,
    };
    eye.xyz().dot(to_viewer) < 0.0
}

#[cfg(test)]
mod tests {
    use glam::camera::{lh, rh};
    use glam::{Affine3A, Mat4, Quat};

    use super::*;

    #[test]
    fn handedness_is_read_from_the_matrix() {
        use DepthConvention as D;
        let rh_view = rh::view::look_at_mat4(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y);
        let lh_view = lh::view::look_at_mat4(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y);
        let cases: [(Mat4, DepthConvention, bool); 6] = [
            (
                rh::proj::directx::perspective(0.8, 1.5, 0.1, 9.0) * rh_view,
                D::Standard,
                false,
            ),
            (
                lh::proj::directx::perspective(0.8, 1.5, 0.1, 9.0) * lh_view,
                D::Standard,
                true,
            ),
            (
                rh::proj::directx::perspective(0.8, 1.5, 9.0, 0.1) * rh_view,
                D::FiniteReverse,
                false,
            ),
            (
                rh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 9.0) * rh_view,
                D::Standard,
                false,
            ),
            (
                lh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 9.0) * lh_view,
                D::Standard,
                true,
            ),
            (
                rh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, 9.0, 0.1) * rh_view,
                D::FiniteReverse,
                false,
            ),
        ];
        for (place, (matrix, depth, left)) in cases.into_iter().enumerate() {
            let view = View::new(matrix, depth).unwrap();
            assert_eq!(is_left_handed(&view), left, "case {place}");
        }
    }

    #[test]
    fn the_object_light_keeps_what_f32_would_lose() {
        let world_from_object = Affine3A::from_scale_rotation_translation(
            Vec3::new(1.0, 0.01, 100.0),
            Quat::from_rotation_y(0.7),
            Vec3::new(1e3, -2.0, 5.0),
        );
        let map = DAffine3::from_mat4(glam::Mat4::from(world_from_object).as_dmat4());
        let light = HomogeneousLight::point(Vec3::new(999.7, 3.3, 5.1));
        let object = ObjectLight::new(light, &map, 0).unwrap();
        let [x, y, z, w] = object.light.map(f64::from);
        let sum = DVec3::new(x, y, z) + Vec3::from(object.rest).as_dvec3();
        let back = map.transform_point3(sum);
        let error = back.distance(light.0.xyz().as_dvec3());
        assert!(w == 1.0 && error < 1e-9, "{error}");
        let rounded = map.transform_point3(DVec3::new(x, y, z));
        assert!(rounded.distance(light.0.xyz().as_dvec3()) > 1e3 * error);
    }

    #[test]
    fn a_flat_transform_has_no_object_light() {
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        let light = HomogeneousLight::directional(Vec3::Y);
        assert!(matches!(
            ObjectLight::new(light, &flat, 7),
            Err(CasterError::Singular { index: 7 })
        ));
    }
}
