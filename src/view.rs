//! The host's camera, reduced to what shadows need: one matrix and its depth convention.

use glam::{DMat4, DVec3, DVec4, Mat4, Vec4Swizzles};

use crate::error::ViewError;

/// How the host's projection maps distance to depth.
///
/// WebGPU's clip space is `0 <= z <= w`, y up. Right-handed or left-handed view spaces both work: only the
/// product `clip_from_world` matters.
///
/// Exhaustive, because a host's own projection depends on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthConvention {
    /// 1 at the near plane, 0 at infinity: clip z is `near` for every point. Choose it if you can (Lengyel,
    /// "Projection Matrix Tricks", 2007; Upchurch and Desbrun, 2012): a vertex at infinity lands exactly at z
    /// = 0, and nothing is clipped at the far end.
    #[default]
    InfiniteReverse,
    /// 1 at the near plane, 0 at a finite far plane. Shadow volumes then need the device feature
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL).
    FiniteReverse,
    /// 0 at the near plane, 1 at the far plane. Shadow volumes then need the device feature
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL).
    Standard,
}

impl DepthConvention {
    /// The depth comparison that passes fragments strictly nearer than the stored depth.
    pub fn nearer(self) -> wgpu::CompareFunction {
        match self {
            Self::Standard => wgpu::CompareFunction::Less,
            Self::InfiniteReverse | Self::FiniteReverse => wgpu::CompareFunction::Greater,
        }
    }

    /// The depth comparison that passes fragments nearer than the stored depth or equal to it.
    pub fn nearer_or_equal(self) -> wgpu::CompareFunction {
        match self {
            Self::Standard => wgpu::CompareFunction::LessEqual,
            Self::InfiniteReverse | Self::FiniteReverse => wgpu::CompareFunction::GreaterEqual,
        }
    }

    /// The value to clear a depth buffer with.
    pub fn clear_depth(self) -> f32 {
        match self {
            Self::Standard => 1.0,
            Self::InfiniteReverse | Self::FiniteReverse => 0.0,
        }
    }

    /// Whether geometry beyond the far plane would be clipped without
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL).
    pub fn clips_far(self) -> bool {
        self != Self::InfiniteReverse
    }

    /// +1 if a larger depth is farther away, -1 if it is nearer.
    pub(crate) fn away(self) -> i32 {
        match self {
            Self::Standard => 1,
            Self::InfiniteReverse | Self::FiniteReverse => -1,
        }
    }
}

/// The host's camera for one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    clip_from_world: Mat4,
    depth: DepthConvention,
    eye: DVec4,
    near_corners: [DVec3; 4],
}

impl View {
    /// A view from the product of the host's projection and view matrices (column vectors:
    /// `clip = clip_from_world * world`), perspective or orthographic, off-centre or not.
    ///
    /// # Errors
    /// [`ViewError`] if an entry is not finite, if the matrix is singular, or if its z row is not
    /// that of `depth`.
    pub fn new(clip_from_world: Mat4, depth: DepthConvention) -> Result<Self, ViewError> {
        if !clip_from_world.is_finite() {
            return Err(ViewError::NotFinite(clip_from_world.to_cols_array()));
        }
        let matrix = clip_from_world.as_dmat4();
        let (x, y, z, w) = (matrix.row(0), matrix.row(1), matrix.row(2), matrix.row(3));
        if !maps_depth(z, w, depth) {
            return Err(ViewError::Depth(depth));
        }
        let eye = null_vector(x, y, w);
        if !eye.is_finite() || eye == DVec4::ZERO {
            return Err(ViewError::Singular);
        }
        let near = f64::from(1.0 - depth.clear_depth());
        let near_corners = corners(matrix, near).ok_or(ViewError::Singular)?;
        Ok(Self {
            clip_from_world,
            depth,
            eye,
            near_corners,
        })
    }

    /// A view from a matrix in f64, for a host that renders relative to `origin`: see
    /// [`Caster::placed`](crate::Caster::placed). The host draws with the view's own
    /// [`clip_from_world`](Self::clip_from_world).
    ///
    /// # Errors
    /// Like [`new`](Self::new), for the matrix relative to `origin`, rounded to f32.
    pub fn placed(
        clip_from_world: DMat4,
        origin: DVec3,
        depth: DepthConvention,
    ) -> Result<Self, ViewError> {
        let relative = clip_from_world * DMat4::from_translation(origin);
        Self::new(relative.as_mat4(), depth)
    }

    /// The matrix the view was made from.
    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_world
    }

    /// The depth convention the view was made with.
    pub fn depth(&self) -> DepthConvention {
        self.depth
    }

    /// The eye in homogeneous world coordinates, up to a factor: `w = 0` for an orthographic view.
    pub fn eye(&self) -> DVec4 {
        self.eye
    }

    /// The corners of the near rectangle in world space, in the order (-1,-1), (1,-1), (1,1), (-1,1).
    pub fn near_corners(&self) -> [DVec3; 4] {
        self.near_corners
    }

    /// For each corner of the near rectangle, the direction of the sight line through it, away from
    /// the viewer, of any length.
    pub(crate) fn sight_lines(&self) -> [DVec3; 4] {
        let matrix = self.clip_from_world.as_dmat4();
        let (x, y, w) = (matrix.row(0), matrix.row(1), matrix.row(3));
        let away = self.forward();
        // Where two planes through the eye meet: without the differences of points that a near plane
        // close to the eye would make small.
        CORNERS.map(|(right, up)| {
            let along = (x - right * w).xyz().cross((y - up * w).xyz());
            if along.dot(away) < 0.0 { -along } else { along }
        })
    }

    /// Where the eye is; `None` if the view is orthographic, whose eye is infinitely far away.
    pub(crate) fn eye_point(&self) -> Option<DVec3> {
        (self.eye.w != 0.0).then(|| self.eye.xyz() / self.eye.w)
    }

    /// The direction in which what is seen gets farther away, of any length: in perspective clip w
    /// does so, in an orthographic view, where it is the same everywhere, depth.
    pub(crate) fn forward(&self) -> DVec3 {
        let row = |index| self.clip_from_world.row(index).xyz().as_dvec3();
        match self.eye_point() {
            Some(_) => row(3),
            None => row(2) * f64::from(self.depth.away()),
        }
    }

    /// The corners of the far rectangle, in the order of [`near_corners`](Self::near_corners);
    /// `None` where nothing is too far away.
    pub(crate) fn far_corners(&self) -> Option<[DVec3; 4]> {
        let far = f64::from(self.depth.clear_depth());
        let matrix = self.clip_from_world.as_dmat4();
        self.depth.clips_far().then(|| corners(matrix, far))?
    }

    /// The near and the far plane, positive between them, in units of clip space; `None` where nothing is too
    /// far away.
    pub(crate) fn near_and_far_planes(&self) -> Option<[DVec4; 2]> {
        let row = |index| self.clip_from_world.row(index).as_dvec4();
        let [from_0, from_1] = [row(2), row(3) - row(2)];
        match self.depth {
            DepthConvention::InfiniteReverse => None,
            DepthConvention::FiniteReverse => Some([from_1, from_0]),
            DepthConvention::Standard => Some([from_0, from_1]),
        }
    }

    /// A sphere around the near rectangle: centre and radius in world space.
    ///
    /// Every ray from the eye to something visible starts inside it.
    pub fn near_sphere(&self) -> (DVec3, f64) {
        let centre = self.near_corners.iter().sum::<DVec3>() / 4.0;
        let radius = self
            .near_corners
            .iter()
            .map(|corner| corner.distance(centre))
            .fold(0.0, f64::max);
        (centre, radius)
    }
}

/// Whether the z row belongs to the convention, judged from how depth changes along the view.
///
/// For a perspective matrix z = a w + b with b < 0 where depth grows with distance and b > 0 where
/// it shrinks; a = 0 exactly where the far plane is at infinity and depth is reversed.
fn maps_depth(z: DVec4, w: DVec4, depth: DepthConvention) -> bool {
    if w.xyz() == DVec3::ZERO {
        // Orthographic: the sign of the z row depends on handedness, which nobody told us.
        return depth != DepthConvention::InfiniteReverse;
    }
    let a = z.xyz().dot(w.xyz()) / w.xyz().length_squared();
    let b = z.w - a * w.w;
    match depth {
        DepthConvention::InfiniteReverse => z.xyz() == DVec3::ZERO && b > 0.0,
        DepthConvention::FiniteReverse => b > 0.0,
        DepthConvention::Standard => b < 0.0,
    }
}

/// The vector orthogonal to three others in four dimensions (their generalised cross product).
pub(crate) fn null_vector(a: DVec4, b: DVec4, c: DVec4) -> DVec4 {
    let minor = |p: fn(DVec4) -> DVec3| p(a).dot(p(b).cross(p(c)));
    DVec4::new(
        minor(|v| v.yzw()),
        -minor(|v| v.xzw()),
        minor(|v| v.xyw()),
        -minor(|v| v.xyz()),
    )
}

/// x and y of the corners of the picture in clip space.
const CORNERS: [(f64, f64); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];

/// Where the corners of the picture are in the world at a depth.
fn corners(clip_from_world: DMat4, depth: f64) -> Option<[DVec3; 4]> {
    let world_from_clip = clip_from_world.inverse();
    let corners = CORNERS
        .map(|(x, y)| world_from_clip * DVec4::new(x, y, depth, 1.0))
        .map(|corner| corner.xyz() / corner.w);
    corners.iter().all(|c| c.is_finite()).then_some(corners)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use glam::camera::rh::{proj::directx as proj, view};

    use super::*;

    fn look_at() -> Mat4 {
        view::look_at_mat4(Vec3::new(0.0, 9.0, 16.0), Vec3::new(0.0, 0.5, 0.0), Vec3::Y)
    }

    #[test]
    fn the_eye_is_found_in_the_matrix() {
        let projection = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
        let view = View::new(projection * look_at(), DepthConvention::InfiniteReverse).unwrap();
        let eye = view.eye().xyz() / view.eye().w;
        assert!(eye.distance(DVec3::new(0.0, 9.0, 16.0)) < 1e-5, "{eye}");
        let (centre, radius) = view.near_sphere();
        assert!((centre.distance(eye) - 0.1).abs() < 1e-5);
        let half_height = 0.1 * (0.4_f64).tan();
        assert!((radius - half_height * (1.0_f64 + 1.5 * 1.5).sqrt()).abs() < 1e-5);
    }

    #[test]
    fn an_orthographic_eye_is_at_infinity() {
        let projection = proj::orthographic(-1.0, 1.0, -1.0, 1.0, 0.1, 10.0);
        let view = View::new(projection * look_at(), DepthConvention::Standard).unwrap();
        assert!(view.eye().w.abs() < 1e-12);
    }

    #[test]
    fn an_orthographic_view_may_begin_behind_its_camera() {
        let camera = look_at();
        let camera_at = DVec3::new(0.0, 9.0, 16.0);
        let along = (DVec3::new(0.0, 0.5, 0.0) - camera_at).normalize();
        for (near, far) in [(0.1_f32, 10.0_f32), (-20.0, 30.0), (-1000.0, -3.0)] {
            let off_centre = |near, far| proj::orthographic(-1.0, 2.0, -1.0, 4.0, near, far);
            for (projection, depth) in [
                (off_centre(near, far), DepthConvention::Standard),
                (off_centre(far, near), DepthConvention::FiniteReverse),
            ] {
                let view = View::new(projection * camera, depth).unwrap();
                assert_eq!(view.eye_point(), None);
                let depths = |corners: [DVec3; 4]| corners.map(|c| (c - camera_at).dot(along));
                let size = f64::from(near.abs().max(far.abs()));
                let is = |depth: f64, plane: f32| (depth - f64::from(plane)).abs() < 1e-4 * size;
                assert!(depths(view.near_corners()).iter().all(|d| is(*d, near)));
                let far_corners = view.far_corners().unwrap();
                assert!(depths(far_corners).iter().all(|d| is(*d, far)));
                for (line, (start, end)) in view
                    .sight_lines()
                    .into_iter()
                    .zip(view.near_corners().into_iter().zip(far_corners))
                {
                    let parallel = line.normalize().dot((end - start).normalize());
                    assert!((parallel - 1.0).abs() < 1e-6, "{parallel}");
                }
            }
        }
    }

    #[test]
    fn sight_lines_run_from_the_eye_through_the_near_rectangle() {
        let mut off_centre = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
        off_centre.z_axis.x = 0.4;
        off_centre.z_axis.y = -0.3;
        for (projection, depth) in [
            (off_centre, DepthConvention::InfiniteReverse),
            (
                proj::perspective(0.8, 1.5, 0.1, 100.0),
                DepthConvention::Standard,
            ),
            (
                proj::perspective(0.8, 1.5, 100.0, 0.1),
                DepthConvention::FiniteReverse,
            ),
        ] {
            let view = View::new(projection * look_at(), depth).unwrap();
            let eye = view.eye_point().unwrap();
            assert_eq!(view.far_corners().is_none(), !depth.clips_far());
            for (line, corner) in view.sight_lines().into_iter().zip(view.near_corners()) {
                let along = line.normalize().dot((corner - eye).normalize());
                assert!((along - 1.0).abs() < 1e-9, "{along}");
            }
        }
    }

    #[test]
    fn a_wrong_convention_is_named() {
        let infinite = proj::perspective_infinite_reverse(0.8, 1.5, 0.1) * look_at();
        let standard = proj::perspective(0.8, 1.5, 0.1, 100.0) * look_at();
        let reverse = proj::perspective(0.8, 1.5, 100.0, 0.1) * look_at();
        use DepthConvention as D;
        assert!(View::new(standard, D::Standard).is_ok());
        assert!(View::new(reverse, D::FiniteReverse).is_ok());
        for (matrix, wrong) in [
            (infinite, D::Standard),
            (standard, D::InfiniteReverse),
            (standard, D::FiniteReverse),
            (reverse, D::Standard),
            (reverse, D::InfiniteReverse),
        ] {
            assert_eq!(View::new(matrix, wrong), Err(ViewError::Depth(wrong)));
        }
    }

    #[test]
    fn a_bad_matrix_is_refused() {
        let mut matrix = proj::perspective_infinite_reverse(0.8, 1.5, 0.1);
        matrix.x_axis.x = 0.0;
        assert_eq!(
            View::new(matrix, DepthConvention::InfiniteReverse),
            Err(ViewError::Singular)
        );
        matrix.x_axis.x = f32::NAN;
        assert!(matches!(
            View::new(matrix, DepthConvention::InfiniteReverse),
            Err(ViewError::NotFinite(_))
        ));
    }
}
