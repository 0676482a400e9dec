//! One of the views that are drawn together, and what it proves of a caster.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::View;
use crate::volume::decide::hull::Hull;
use crate::volume::decide::near_plane::NearPlane;
use crate::volume::decide::world_box::WorldBox;

/// What a view has to do with a light.
#[derive(Debug)]
pub(crate) struct Sight {
    /// From where rays start to the light: what misses it casts no shadow on the near rectangle.
    near: Hull,
    /// From all that is visible to the light: what misses it casts no visible shadow.
    visible: Hull,
    /// Of a view that clips both; positive between them.
    near_and_far: Option<[DVec4; 2]>,
    light_reaches_view: bool,
}

impl Sight {
    /// Of a light, a direction of length 1, that reaches no more than a ball of this centre and radius.
    pub fn new(
        view: &View,
        near_plane: NearPlane,
        light: DVec4,
        reached: Option<(DVec3, f64)>,
    ) -> Self {
        let mut frustum: Vec<DVec4> = view.near_corners().map(|c| c.extend(1.0)).to_vec();
        // Endless: a far plane hides little, and its corners are badly known in f32 matrices.
        frustum.extend(view.sight_lines().map(|d| d.normalize().extend(0.0)));
        let seen = Hull::new(&frustum);
        let is_seen = |(centre, radius)| !seen.misses_sphere(centre, radius);
        let light_reaches_view = reached.is_none_or(is_seen);
        frustum.push(light);
        let mut near = origins(view, near_plane);
        near.push(light);
        Self {
            near: Hull::new(&near),
            visible: Hull::new(&frustum),
            near_and_far: view.near_and_far_planes(),
            light_reaches_view,
        }
    }

    /// Whether no ray starts in the shadow of a caster.
    pub fn starts_lit(&self, world: &WorldBox) -> bool {
        self.near.misses(world)
    }

    /// Whether nothing of a caster's shadow can be seen.
    pub fn misses_shadow(&self, world: &WorldBox) -> bool {
        !self.light_reaches_view || self.visible.misses(world)
    }

    /// Whether a caster is certainly on the inner side of the near and of the far plane, where the view
    /// has a far plane.
    pub fn holds(&self, world: &WorldBox) -> Option<[bool; 2]> {
        let within = |plane: DVec4| {
            let normal = plane.xyz();
            let size = normal.length() * world.reach(DVec3::ZERO) + plane.w.abs();
            world.nearest(normal) + plane.w > 1e-5 * size
        };
        self.near_and_far.map(|planes| planes.map(within))
    }
}

/// The points from which rays start, such that all others are between them.
pub(crate) fn origins(view: &View, near_plane: NearPlane) -> Vec<DVec4> {
    let mut points = view
        .near_corners()
        .map(|corner| corner.extend(1.0))
        .to_vec();
    if near_plane.ends_faces() {
        return points;
    }
    let eye = view.eye();
    points.push(match eye.w == 0.0 {
        true => (-view.sight_lines()[0].normalize()).extend(0.0),
        false => eye / eye.w,
    });
    points
}
