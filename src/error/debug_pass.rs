//! Errors of the debug views of shadow maps.

use thiserror::Error;

/// What can be wrong with the pass that an [`AtlasDebug`](crate::AtlasDebug) or a
/// [`CubeCross`](crate::CubeCross) is made for.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum DebugPassError {
    /// The format cannot be drawn into on this device, with as many samples.
    #[error(
        "{0:?} cannot be drawn into on this device with as many samples; pass a colour format that can"
    )]
    ColorFormat(wgpu::TextureFormat),
    /// The format has no depth or stencil, or the device was created without it.
    #[error(
        "{0:?} is not a depth-stencil format of this device; pass that of the pass, None if it has none, and ask for the feature of its name where there is one"
    )]
    DepthStencil(wgpu::TextureFormat),
    /// The sample count is neither 1 nor 4.
    #[error("{0} samples are not supported; pass 1 or 4, which every device has")]
    SampleCount(u32),
}
