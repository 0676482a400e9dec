//! What has to be decided for a caster before its volume can be extracted. All in f64.

use glam::{DAffine3, DVec3, DVec4, Vec3, Vec4Swizzles as _};

use crate::mesh::{Bounds, CasterMesh, MeshKind};
use crate::volume::StartFrom;
use crate::volume::decide::world_box::WorldBox;
use crate::volume::frame::Situation;
use crate::{DepthConvention, HomogeneousLight, View};

/// Which triangles of a mesh count; as the shaders have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Counted {
    /// Those facing the light.
    LightFacing = 0,
    /// All, turned toward the light.
    All = 1,
    /// Those turned away from the light, turned over.
    AwayFacing = 2,
}

impl Counted {
    pub fn of(mesh: &CasterMesh, world: &WorldBox, of: &Situation, start: StartFrom) -> Self {
        match start {
            _ if counts_both_sides(mesh, world, of.light, &of.views) => Self::All,
            // Inside out, the triangles turned away would be those that the light reaches. Where only
            // the GPU knows the positions, the host is believed.
            StartFrom::AwayFacing if mesh.is_solid() || mesh.data().is_none() => Self::AwayFacing,
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
/// With L or the eye inside, f and b differ, and f = 0 may go with b > 0. Of views that are drawn
/// together, that goes for all: every triangle may always count.
fn counts_both_sides(
    mesh: &CasterMesh,
    world: &WorldBox,
    light: HomogeneousLight,
    views: &[View],
) -> bool {
    if mesh.kind() == MeshKind::General {
        return true;
    }
    let is_outside = |view: &View| {
        let (near, radius) = view.near_sphere();
        // The near rectangle stems from a matrix of f32, too.
        world.distance(near) > radius * (1.0 + 8.0 * f64::from(f32::EPSILON))
    };
    !(world.excludes(light) && views.iter().all(is_outside))
}

/// The light in a mesh's own space, homogeneous, and what its xyz lost when rounded to f32.
///
/// A triangle a, a + u, a + v of a mesh under the map p -> M p + t faces the light (l, w) by the sign
/// of det(M u, M v, l - w (M a + t)), which is det(u, v, adj(M) (l - w t) - w det(M) a). So the light
/// is at adj(M) (l - w t), with det(M) w for its w, and nothing here is divided: the map may flatten
/// the mesh. The light is then the direction along which it does, on the side on which it is of what is
/// left of the mesh: its triangles face the light or not as they come to lie in that plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ObjectLight {
    pub light: [f32; 4],
    pub rest: [f32; 3],
    pub origin: RayOrigin,
}

/// Where the rays from a point light are counted from: a point of the mesh's box as near to the light
/// as any, and where that is from the light in world space. What this differs by from a vertex is no
/// larger than the mesh, whatever its coordinates are counted from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RayOrigin {
    pub anchor: [f32; 3],
    pub from_light: [f32; 3],
}

impl ObjectLight {
    /// `None` where all that is left of the mesh is seen from its edge, so that it casts nothing: a
    /// line, a point, or a plane that holds the light.
    pub fn new(light: HomogeneousLight, map: &DAffine3, bounds: Bounds) -> Option<Self> {
        let (place, w) = (light.0.xyz().as_dvec3(), f64::from(light.0.w));
        let m = map.matrix3;
        let determinant = m.determinant();
        // Turned inside out, what faces the light in the mesh's space is turned from it in the world's.
        let side = if determinant < 0.0 { -1.0 } else { 1.0 };
        let from_origin = side * (place - w * map.translation);
        let adjugate = [
            m.y_axis.cross(m.z_axis),
            m.z_axis.cross(m.x_axis),
            m.x_axis.cross(m.y_axis),
        ];
        let xyz = DVec3::from(adjugate.map(|row| row.dot(from_origin)));
        let w = side * determinant * w;
        if xyz == DVec3::ZERO && w == 0.0 {
            return None;
        }
        let point = (w != 0.0).then(|| xyz / w);
        let (exact, w) = match point {
            Some(point) if point.abs().max_element() < FARTHEST => (point, 1.0),
            // So far away, for f32 or for good, that all but its direction is lost.
            Some(point) => (unit_exponent(point), unit_scale(point)),
            None => (unit_exponent(xyz), 0.0),
        };
        let rounded = exact.as_vec3();
        let rest = (exact - rounded.as_dvec3()).as_vec3();
        Some(Self {
            light: rounded.extend(w as f32).to_array(),
            rest: rest.to_array(),
            origin: RayOrigin::new(place, map, bounds, point),
        })
    }
}

impl RayOrigin {
    fn new(light: DVec3, map: &DAffine3, bounds: Bounds, point: Option<DVec3>) -> Self {
        let anchor = match point {
            Some(point) => point.as_vec3().clamp(bounds.min, bounds.max),
            None => bounds.min.midpoint(bounds.max),
        };
        let from_light = map.transform_point3(anchor.as_dvec3()) - light;
        Self {
            anchor: anchor.to_array(),
            from_light: from_light.as_vec3().to_array(),
        }
    }
}

/// Coordinates from which on a light is scaled down to those of a direction: far enough from the
/// largest of f32 for what shaders make of them.
const FARTHEST: f64 = 18_446_744_073_709_551_616.0; // 2^64

/// A direction scaled by a power of two (so exactly) to a largest component between 1 and 2.
fn unit_exponent(direction: DVec3) -> DVec3 {
    direction * unit_scale(direction)
}

/// That power of two.
fn unit_scale(direction: DVec3) -> f64 {
    (-direction.abs().max_element().log2().floor()).exp2()
}

/// The light as the draws take it: a direction of any length, without the risk of overflow.
pub(crate) fn world_light(light: HomogeneousLight) -> [f32; 4] {
    if light.is_directional() {
        let direction: Vec3 = unit_exponent(light.0.xyz().as_dvec3()).as_vec3();
        return direction.extend(0.0).to_array();
    }
    light.0.to_array()
}

/// What depth rounds by at least, with the sign of what is farther away: a unit of the last place of
/// the depth at infinity, or of the range where there is none. See `volume_depth_steps.wgsl`.
pub(crate) fn depth_step(view: &View) -> f32 {
    let matrix = view.clip_from_world();
    let (z, w) = (matrix.row(2).as_dvec4(), matrix.row(3).as_dvec4());
    let at_infinity = match w.xyz() {
        DVec3::ZERO => 1.0,
        w => z.xyz().dot(w) / w.length_squared(),
    };
    let unit = f64::from(f32::EPSILON) / 2.0;
    (f64::from(view.depth().away()) * at_infinity.abs() * unit) as f32
}

/// Whether a triangle whose normal (b - a) x (c - a) points to the viewer is clockwise on screen.
///
/// Its signed area on screen has the sign of normal . (eye - w a), with the homogeneous eye that is
/// the generalised cross product of the matrix's x, y and w rows.
pub(crate) fn is_left_handed(view: &View) -> bool {
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
        let object = ObjectLight::new(light, &map, UNIT).unwrap();
        let [x, y, z, w] = object.light.map(f64::from);
        let sum = DVec3::new(x, y, z) + Vec3::from(object.rest).as_dvec3();
        let back = map.transform_point3(sum);
        let error = back.distance(light.0.xyz().as_dvec3());
        assert!(w == 1.0 && error < 1e-9, "{error}");
        let rounded = map.transform_point3(DVec3::new(x, y, z));
        assert!(rounded.distance(light.0.xyz().as_dvec3()) > 1e3 * error);
    }

    const UNIT: Bounds = Bounds {
        min: Vec3::splat(-1.0),
        max: Vec3::ONE,
    };

    fn lights() -> [HomogeneousLight; 3] {
        [
            HomogeneousLight::point(Vec3::new(0.3, 4.0, -0.7)),
            HomogeneousLight::point(Vec3::new(2.0, -3.0, 1.0)),
            HomogeneousLight::directional(Vec3::new(0.2, 1.0, -0.4)),
        ]
    }

    /// Maps that flatten, or all but do, in the mesh's space and in the world's.
    fn flat_maps() -> Vec<DAffine3> {
        let turn = |angle| DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), angle);
        let place = DAffine3::from_translation(DVec3::new(0.5, 0.25, -1.5));
        let thin = [0.0, 1e-45, 1e-38, 1e-30, 1e-12, -1e-12, -1e-38];
        let scale = |y| DAffine3::from_scale(DVec3::new(1.0, y, 1.5));
        let maps = thin.into_iter().flat_map(|y| {
            [
                place * scale(y),
                place * turn(0.7) * scale(y),
                place * scale(y) * turn(0.7),
                place * turn(-0.3) * scale(y) * turn(0.7),
            ]
        });
        // As a caster has them.
        maps.map(|map| {
            let [x, y, z] = [0, 1, 2].map(|axis| map.matrix3.col(axis).as_vec3().as_dvec3());
            let translation = map.translation.as_vec3().as_dvec3();
            DAffine3::from_cols(x, y, z, translation)
        })
        .collect()
    }

    #[test]
    fn triangles_of_a_flattened_mesh_face_the_light_as_they_lie_in_the_world() {
        let mut found = [0; 2];
        for map in flat_maps() {
            let mirrored = map.matrix3.determinant() < 0.0;
            for light in lights() {
                let object = ObjectLight::new(light, &map, UNIT).unwrap();
                let [x, y, z, w] = object.light.map(f64::from);
                let xyz = DVec3::new(x, y, z) + Vec3::from(object.rest).as_dvec3();
                for corner in 0..8 {
                    let a = DVec3::new(1.0, 0.2, 0.1 * f64::from(corner));
                    let (u, v) = (DVec3::new(-0.5, 0.3, 1.0), DVec3::new(0.4, -0.6, -0.2));
                    let v = if corner & 1 == 0 { v } else { -v };
                    let own = u.cross(v).dot(xyz - w * a);
                    let [world_u, world_v] = [u, v].map(|edge| map.transform_vector3(edge));
                    let (place, world_w) = (light.0.xyz().as_dvec3(), f64::from(light.0.w));
                    let to_light = place - world_w * map.transform_point3(a);
                    let world = world_u.cross(world_v).dot(to_light);
                    assert!(own != 0.0 && world != 0.0, "{map:?}, {light:?}");
                    let turned = if mirrored { -own } else { own };
                    assert_eq!(turned > 0.0, world > 0.0, "{map:?}, {light:?}");
                    found[usize::from(world > 0.0)] += 1;
                }
            }
        }
        assert!(found.iter().all(|count| *count > 200), "{found:?}");
    }

    #[test]
    fn rays_start_at_the_light_however_flat_the_mesh_is() {
        for map in flat_maps() {
            for light in &lights()[..2] {
                let origin = ObjectLight::new(*light, &map, UNIT).unwrap().origin;
                let [anchor, from_light] =
                    [origin.anchor, origin.from_light].map(|v| Vec3::from(v).as_dvec3());
                let corner = DVec3::new(1.0, -1.0, 0.5);
                let found = map.transform_vector3(corner - anchor) + from_light;
                let right = map.transform_point3(corner) - light.0.xyz().as_dvec3();
                assert!(found.distance(right) < 1e-6 * right.length(), "{map:?}");
            }
        }
        // By the light in the mesh's own space, as of a mesh that is not flat, it is lost.
        let thin = DAffine3::from_scale(DVec3::new(1.0, 1e-12, 1.0));
        let inverse = thin.inverse().transform_point3(DVec3::new(0.3, 4.0, -0.7));
        let lost = thin.transform_vector3(-inverse.as_vec3().as_dvec3());
        assert!(lost.distance(DVec3::new(-0.3, -4.0, 0.7)) > 1e-8);
    }

    #[test]
    fn what_is_seen_from_its_edge_has_no_light() {
        let level = HomogeneousLight::directional(Vec3::X);
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert!(ObjectLight::new(level, &flat, UNIT).is_none());
        let in_plane = HomogeneousLight::point(Vec3::new(5.0, 0.0, 1.0));
        assert!(ObjectLight::new(in_plane, &flat, UNIT).is_none());
        for light in lights() {
            for gone in [DVec3::ZERO, DVec3::X] {
                assert!(ObjectLight::new(light, &DAffine3::from_scale(gone), UNIT).is_none());
            }
        }
        // At the origin of a mesh that is not flat, the light is at 0, which is a place.
        let origin = HomogeneousLight::point(Vec3::ZERO);
        assert!(ObjectLight::new(origin, &DAffine3::IDENTITY, UNIT).is_some());
    }
}
