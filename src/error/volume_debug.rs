//! Errors of the debug views of shadow volumes.

use thiserror::Error;

use super::{ScreenPassError, ShadowVolumeError, VolumeRenderError};

/// What can be wrong when a [`VolumeDebug`](crate::VolumeDebug) is made or prepared.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum VolumeDebugError {
    /// A format or the sample count of the pass.
    #[error(transparent)]
    Target(#[from] ScreenPassError),
    /// The device lacks a feature or a limit, or a caster is not sound.
    #[error(transparent)]
    Volume(#[from] ShadowVolumeError),
    /// The renderer has no such light or view.
    #[error(transparent)]
    Render(#[from] VolumeRenderError),
    /// The renderer has another depth convention.
    #[error(
        "the renderer's depth is {renderer:?}, these debug views were made for {debug:?}; pass its convention in VolumeDebugDescriptor::depth"
    )]
    Depth {
        /// The convention of the debug views.
        debug: crate::DepthConvention,
        /// The renderer's.
        renderer: crate::DepthConvention,
    },
    /// The stencil's counts are asked for, and the buffer has none.
    #[error(
        "{0:?} has no stencil whose counts could be shown; count with Counter::Exact and show them by VolumeDebug::draw_exact_counts"
    )]
    NoStencil(wgpu::TextureFormat),
    /// The frame is not the one that the renderer was prepared with.
    #[error(
        "the frame has {frame} casters, the renderer was prepared with {renderer}; prepare the renderer with this frame first"
    )]
    Casters {
        /// Casters of the frame.
        frame: usize,
        /// Casters that the renderer decided about.
        renderer: usize,
    },
}
