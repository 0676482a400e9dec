//! When static casters are kept in layers of their own.

use crate::error::CubeShadowMapError;

/// Whether the static casters of a face are kept in a second layer of depth, which is copied under
/// those that move, instead of being drawn again with them.
///
/// A caster is static for a face once it has been the same in three draws of that face (more
/// after layers that were of no use, up to 64); so a scene in which all casters move takes no memory
/// and copies nothing. A layer is made for each face that has use for one, with as many bytes as
/// the face. Depths are the same bit for bit with and without.
///
/// Layers need copies between depth textures, which wgpu's GL back end does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StaticLayers {
    /// Where enough triangles are static for the texels of a face. Nowhere on the GL back end.
    ///
    /// On software drivers one triangle is enough for 1024 texels: 64 on a face of 256 texels a side, 1,024
    /// on one of 1024. Mesa's llvmpipe draws a small triangle in the time in which it copies 120 to 180 texels
    /// (`docs/benches.md`), and copies a layer as fast as it clears a face. So a layer costs nothing but
    /// making it, one copy, which this rule repays within eight frames.
    ///
    /// On GPUs one triangle is enough for 16 texels. That is an estimate, not a measurement: it assumes that
    /// clearing is free, that a copied texel moves 12 bytes (read, written, and read again by the pass
    /// over it) at 500 GB/s, and that 2.5 triangles are drawn per nanosecond. Where you know better, use
    /// [`AtLeast`](Self::AtLeast).
    #[default]
    Auto,
    /// Nowhere.
    Never,
    /// Where at least so many triangles are static on a face that is drawn (and at least one).
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
