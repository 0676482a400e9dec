//! The light rays beside a pixel's own, as a shadow map's texels have them.

use glam::{DMat3, DMat4, DVec3, Vec4Swizzles as _};

/// The kinds of map.
#[derive(Clone, Copy, Debug)]
pub(super) enum MapRays {
    /// Around the light, whose faces have edges of 2 at distance 1.
    Cube,
    /// With this matrix from world to clip space.
    Flat(DMat4),
    /// A light map's, whose texels lie on the surface.
    Surface,
}

/// The rays around the one through a point.
pub(super) enum Rays {
    Cube {
        light: DVec3,
        toward: FaceDirection,
        position: DVec3,
        normal: DVec3,
    },
    Flat {
        clip_from_world: DMat4,
        place: [f64; 2],
        position: DVec3,
        normal: DVec3,
    },
    Surface {
        position: DVec3,
        axes: (DVec3, DVec3),
    },
}

impl Rays {
    /// `light` is the position of a cube map's light.
    pub fn new(map: &MapRays, light: DVec3, position: DVec3, normal: DVec3) -> Self {
        match *map {
            MapRays::Cube => Self::Cube {
                light,
                toward: FaceDirection::new(position - light),
                position,
                normal,
            },
            MapRays::Flat(clip_from_world) => {
                let clip = clip_from_world * position.extend(1.0);
                Self::Flat {
                    clip_from_world,
                    place: [clip.x / clip.w, clip.y / clip.w],
                    position,
                    normal,
                }
            }
            MapRays::Surface => Self::Surface {
                position,
                axes: normal.any_orthonormal_pair(),
            },
        }
    }

    /// The offsets `u` and `v` of the ray through a point, times a third number that is positive in front of the
    /// light. A light map has no rays: 0.
    pub fn place(&self, point: DVec3) -> DVec3 {
        match self {
            Self::Surface { .. } => DVec3::ZERO,
            Self::Cube { light, toward, .. } => toward.place(point - light),
            Self::Flat {
                clip_from_world,
                place,
                ..
            } => {
                let clip = clip_from_world * point.extend(1.0);
                let aside = [clip.x - place[0] * clip.w, clip.y - place[1] * clip.w];
                DVec3::new(aside[0], aside[1], clip.w)
            }
        }
    }

    /// Where the ray `u` and `v` beside meets the point's tangent plane, in units in which the
    /// map's edge is 2 long, of a light map in world units; `None` if it does not.
    pub fn meet(&self, u: f64, v: f64) -> Option<DVec3> {
        match self {
            Self::Surface {
                position,
                axes: (across, along),
            } => Some(position + u * across + v * along),
            Self::Cube {
                light,
                toward,
                position,
                normal,
            } => {
                let direction = toward.offset(u, v);
                // The light is on the side of the normal, or the pixel would face away.
                let t = normal.dot(position - light) / normal.dot(direction);
                (t > 0.0 && t.is_finite()).then(|| light + t * direction)
            }
            Self::Flat {
                clip_from_world,
                place,
                position,
                normal,
            } => {
                let rows = clip_from_world.transpose();
                // The two planes that hold the ray, and the tangent plane: three equations.
                let across = rows.x_axis - (place[0] + u) * rows.w_axis;
                let down = rows.y_axis - (place[1] + v) * rows.w_axis;
                let point = position.extend(1.0);
                let planes = DMat3::from_cols(across.xyz(), down.xyz(), *normal).transpose();
                let aside = DVec3::new(-across.dot(point), -down.dot(point), 0.0);
                let met = position + planes.inverse() * aside;
                let before_light = rows.w_axis.dot(met.extend(1.0)) > 0.0;
                (met.is_finite() && before_light).then_some(met)
            }
        }
    }
}

/// A direction from the light with the axes of the cube face it goes through.
pub(super) struct FaceDirection {
    /// Scaled to 1 along the major axis.
    direction: DVec3,
    u: DVec3,
    v: DVec3,
}

impl FaceDirection {
    fn new(direction: DVec3) -> Self {
        let size = direction.abs();
        let major = size.max_element();
        let (u, v) = if size.x == major {
            (DVec3::Y, DVec3::Z)
        } else if size.y == major {
            (DVec3::Z, DVec3::X)
        } else {
            (DVec3::X, DVec3::Y)
        };
        Self {
            direction: direction / major,
            u,
            v,
        }
    }

    fn offset(&self, u: f64, v: f64) -> DVec3 {
        self.direction + u * self.u + v * self.v
    }

    /// What [`offset`](Self::offset) makes a direction from, times how long it is along the major axis.
    fn place(&self, direction: DVec3) -> DVec3 {
        // The third axis, on the side of the own direction.
        let major = self.u.cross(self.v);
        let along = direction.dot(major) / self.direction.dot(major);
        let aside = direction - along * self.direction;
        DVec3::new(aside.dot(self.u), aside.dot(self.v), along)
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3, camera::rh};

    use super::*;

    /// A spot that looks down a cube's -y face, with the frustum of that face.
    #[test]
    fn a_flat_map_like_a_cube_face_has_that_faces_rays() {
        let light = DVec3::new(1.0, 5.0, -2.0);
        let eye = light.as_vec3();
        let view: Mat4 = rh::view::look_at_mat4(eye, eye - Vec3::Y, Vec3::Z);
        let projection =
            rh::proj::directx::perspective_infinite_reverse(std::f32::consts::FRAC_PI_2, 1.0, 0.1);
        let map = MapRays::Flat((projection * view).as_dmat4());
        let position = DVec3::new(2.0, 0.5, -1.0);
        let normal = DVec3::new(0.2, 1.0, 0.1).normalize();
        let cube = Rays::new(&MapRays::Cube, light, position, normal);
        let flat = Rays::new(&map, light, position, normal);
        for angle in 0..8 {
            let (v, u) = (f64::from(angle) * 0.8).sin_cos();
            // Up to the axes' names and signs: rings are the same.
            let from_flat = flat.meet(0.01 * u, 0.01 * v).unwrap();
            let along = (from_flat - light) / (light.y - from_flat.y);
            let own = (position - light) / (light.y - position.y);
            let ring = (along - own).length();
            assert!((ring - 0.01).abs() < 1e-7, "{ring}");
            assert!(normal.dot(from_flat - position).abs() < 1e-12);
            assert!(cube.meet(0.01 * u, 0.01 * v).is_some());
        }
        // Past the horizon of the tangent plane there is nothing to meet.
        let steep = DVec3::new(-1.0, 0.25, 0.0).normalize();
        for map in [&MapRays::Cube, &map] {
            let rays = Rays::new(map, light, position, steep);
            assert!(rays.meet(1e-3, 0.0).is_some() && rays.meet(0.0, 1e-3).is_some());
            let far = [(3.0, 0.0), (-3.0, 0.0), (0.0, 3.0), (0.0, -3.0)];
            assert!(far.into_iter().any(|(u, v)| rays.meet(u, v).is_none()));
        }
    }

    #[test]
    fn rays_of_a_directional_light_are_parallel() {
        let map = MapRays::Flat(DMat4::from_scale(DVec3::new(0.5, 0.25, 1.0)));
        let rays = Rays::new(&map, DVec3::NAN, DVec3::ONE, DVec3::Z);
        let met = rays.meet(0.1, -0.1).unwrap();
        assert!((met - DVec3::new(1.2, 0.6, 1.0)).length() < 1e-12, "{met}");
        // Seen edge-on, the plane is met by no ray.
        let rays = Rays::new(&map, DVec3::NAN, DVec3::ONE, DVec3::X);
        assert_eq!(rays.meet(0.1, 0.0), None);
    }
}
