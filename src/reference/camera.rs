//! The rays of a host's camera, in f64.

use glam::{DMat4, DVec3, DVec4, Vec4Swizzles};

use crate::View;

/// What a pixel sees lies on `origin + t * direction`, `0 <= t <= end`: from the near plane to the
/// far plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelRay {
    pub(super) origin: DVec3,
    /// Unit length.
    pub(super) direction: DVec3,
    pub(super) end: f64,
}

impl PixelRay {
    pub(super) fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Distance of a point from the ray's line.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        (point - self.origin).cross(self.direction).length()
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    world_from_clip: DMat4,
    near: f64,
    far: f64,
    clips_far: bool,
    width: u32,
    height: u32,
    /// The row that is asked for as 0.
    first_row: u32,
}

impl Camera {
    pub(super) fn new(view: &View, width: u32, height: u32) -> Self {
        let far = f64::from(view.depth().clear_depth());
        Self {
            world_from_clip: view.clip_from_world().as_dmat4().inverse(),
            near: 1.0 - far,
            far,
            clips_far: view.depth().clips_far(),
            width,
            height,
            first_row: 0,
        }
    }

    /// The same, with rows counted from this one.
    pub(super) fn starting_at(self, first_row: u32) -> Self {
        Self { first_row, ..self }
    }

    /// The ray through the centre of a pixel; `(0, 0)` is top left.
    ///
    /// Clip space is projective: the points of one pixel are `A + s B` with B the image of the clip
    /// z axis, in perspective the eye, in an orthographic view the axis itself. The derivative of
    /// their quotient at the near plane is the direction, for either kind and either handedness.
    pub(super) fn ray(&self, x: u32, y: u32) -> PixelRay {
        let clip_x = (2.0 * f64::from(x) + 1.0) / f64::from(self.width) - 1.0;
        let row = f64::from(y) + f64::from(self.first_row);
        let clip_y = 1.0 - (2.0 * row + 1.0) / f64::from(self.height);
        let at = |z| self.world_from_clip * DVec4::new(clip_x, clip_y, z, 1.0);
        let near = at(self.near);
        let axis = self.world_from_clip.z_axis * (self.far - self.near);
        let origin = near.xyz() / near.w;
        let direction = (axis.xyz() * near.w - near.xyz() * axis.w).normalize();
        let end = if self.clips_far {
            let far = at(self.far);
            (far.xyz() / far.w - origin).dot(direction)
        } else {
            f64::INFINITY
        };
        PixelRay {
            origin,
            direction,
            end,
        }
    }
}
