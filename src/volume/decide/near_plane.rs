//! What becomes of a volume's faces before the camera's near plane.

use crate::DepthConvention;

/// How faces end at the near plane.
///
/// Where a projection has a far plane, depth is not clipped, so that faces beyond it count; WebGPU then
/// spares the near plane, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NearPlane {
    /// The rasteriser clips them, as it does the host's surfaces.
    Clipped,
    /// Vertex shaders cut them there by a clip distance: see `volume_corner_cut.wgsl`.
    Cut,
    /// They go on to the eye: the device has no clip distances.
    Passed,
}

impl NearPlane {
    pub fn of(features: wgpu::Features, depth: DepthConvention) -> Self {
        match depth.clips_far() {
            false => Self::Clipped,
            true if features.contains(wgpu::Features::CLIP_DISTANCES) => Self::Cut,
            true => Self::Passed,
        }
    }

    /// Whether nothing before the near plane is drawn, so that rays start there.
    pub fn ends_faces(self) -> bool {
        self != Self::Passed
    }

    /// What the shaders of a volume's faces need to know: a pipeline's constant.
    pub fn depth(self, depth: DepthConvention) -> Option<(&'static str, f64)> {
        let near_depth = match depth {
            DepthConvention::Standard => 0.0,
            DepthConvention::InfiniteReverse | DepthConvention::FiniteReverse => 1.0,
        };
        (self == Self::Cut).then_some(("near_depth", near_depth))
    }
}
