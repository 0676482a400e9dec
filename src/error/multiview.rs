//! Errors of views that are drawn together.

use thiserror::Error;

/// Why views cannot be drawn together as
/// [`multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask) says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MultiviewError {
    /// The views do not fill all passes.
    #[error(
        "{views} views do not fill passes of {together}, as many as multiview_mask has bits; pass a multiple of that"
    )]
    Views {
        /// Views of the frame.
        views: usize,
        /// Views that a pass draws.
        together: usize,
    },
    /// Views of one pass have one target, of which one size was told.
    #[error(
        "view {view} has the target size {found:?}, the first view of its pass {needed:?}; layers of one target are of one size"
    )]
    TargetSize {
        /// Place in the frame's list of views.
        view: usize,
        /// The size found there.
        found: Option<[u32; 2]>,
        /// That of the first view of the pass.
        needed: Option<[u32; 2]>,
    },
    /// A pipeline takes triangles of one sense of rotation for front faces, in all layers.
    #[error(
        "view {view} is mirrored (left and right exchanged) and the first view of its pass is not, or the other way round; draw them in passes of their own"
    )]
    Mirrored {
        /// Place in the frame's list of views.
        view: usize,
    },
}
