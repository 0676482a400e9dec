//! When static casters are cached in layers of their own.

use crate::error::CubeShadowMapError;

/// Whether the static casters of a face are cached in a second depth layer, which is copied before the moving
/// ones are drawn, instead of being redrawn along with them.
///
/// A caster counts as static for a face once it has stayed the same in three draws of that face (in more, up
/// to 64, after layers that proved useless), so a scene in which all casters move takes no memory and copies
/// nothing. A layer is created for each face that benefits from one, and takes as many bytes as the face.
/// Depths are bit-identical with and without layers.
///
/// Layers need copies between depth textures, which wgpu's GL back end does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StaticLayers {
    /// Where a face has enough static triangles relative to its texels. Never on the GL back end.
    ///
    /// On software drivers, enough is one triangle per 1024 texels: 64 for a face of 256 texels a side, 1,024
    /// for one of 1024. Mesa's llvmpipe draws a small triangle in the time it takes to copy 120 to 180 texels
    /// (`docs/benches.md`), and copies a layer as fast as it clears a face. A layer therefore costs no more
    /// than the one copy that creates it, which this rule repays within eight frames.
    ///
    /// On GPUs, enough is one triangle per 16 texels. That is an estimate, not a measurement: it assumes that
    /// clearing is free, that a copied texel moves 12 bytes (read, written, and read again by the pass over
    /// it) at 500 GB/s, and that 2.5 triangles are drawn per nanosecond. If you know better, use
    /// [`AtLeast`](Self::AtLeast).
    #[default]
    Auto,
    /// Never.
    Never,
    /// Where a face to be drawn has at least this many static triangles (and at least one).
    AtLeast(u64),
}

impl StaticLayers {
    /// The fewest triangles that are worth a layer under a face; `None` if there is to be none.
    pub(super) fn least_triangles(self, size: u32, adapter: &wgpu::AdapterInfo) -> Option<u64> {
        let texels_a_triangle = match adapter.device_type {
            wgpu::DeviceType::Cpu => 1024,
            _ => 16,
        };
        match self {
            Self::Never => None,
            Self::AtLeast(triangles) => Some(triangles.max(1)),
            Self::Auto if adapter.backend == wgpu::Backend::Gl => None,
            Self::Auto => Some(u64::from(size).pow(2).div_ceil(texels_a_triangle)),
        }
    }

    /// Refuses layers that the device cannot copy.
    pub(super) fn validate(self, adapter: &wgpu::AdapterInfo) -> Result<(), CubeShadowMapError> {
        match (self, adapter.backend) {
            (Self::AtLeast(_), wgpu::Backend::Gl) => Err(CubeShadowMapError::StaticLayers),
            _ => Ok(()),
        }
    }
}
