//! What a frame of an atlas took, for a host to show.

use std::time::Duration;

use crate::map::plan::Tally;

/// What the last [`ShadowAtlas::prepare`](crate::ShadowAtlas::prepare) found and the next `encode` will
/// do.
///
/// Each tile of each light in the frame is one of rendered, kept, empty, hidden and postponed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct AtlasStatistics {
    /// Tiles that will be drawn, or cleared because their last caster left.
    pub tiles_rendered: u32,
    /// Tiles with casters whose content has not changed since they were drawn.
    pub tiles_kept: u32,
    /// Tiles without a caster, clear already or without texels.
    pub tiles_empty: u32,
    /// Tiles that changed but can hold no receiver that a view shows.
    pub tiles_hidden: u32,
    /// Tiles that changed and wait for a later frame's budget.
    pub tiles_postponed: u32,
    /// Those of `tiles_rendered` whose static casters are copied from a second layer
    /// ([`StaticLayers`](crate::StaticLayers)), not drawn.
    pub tiles_copied: u32,
    /// Tiles of second layers that are drawn, to be copied in this frame and later ones.
    pub static_tiles_drawn: u32,
    /// Tiles that the last `encode` drew without casters that only the host can draw, as it was not asked
    /// to ([`ShadowAtlas::encode_with`](crate::ShadowAtlas::encode_with)): counted when it does so, and drawn
    /// again in the next frame.
    pub tiles_incomplete: u32,
    /// Lights that want larger tiles than there is room for.
    pub lights_reduced: u32,
    /// Lights whose tiles changed size or place, and are drawn anew for that.
    pub lights_moved: u32,
    /// Casters that touch a tile, counted once for each light.
    pub casters_in_range: u32,
    /// Casters that touch none, counted once for each light.
    pub casters_out_of_range: u32,
    /// Draw calls.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// Layers of the texture.
    pub layers: u32,
    /// Texels in tiles.
    pub texels: u64,
    /// GPU memory held: textures and buffers, without the staging buffers in which `uploaded` waits:
    /// these are kept, of powers of two from 64 KB on, as many as frames wait for the GPU.
    pub bytes: u64,
    /// Bytes that `encode` copies to the GPU: none where nothing has changed.
    pub uploaded: u64,
    /// Whether what the `prepare` before this one found necessary was never encoded: this one found it
    /// again. Of a host that prepares and encodes once a frame, always false.
    pub not_encoded: bool,
    /// Whether an encoder that an `encode` had recorded into was dropped instead of submitted, since
    /// the last `prepare`: everything is drawn again.
    pub encoder_dropped: bool,
    /// CPU time of `prepare`. Zero on the web, where the standard library has no clock.
    pub prepare: Duration,
}

impl AtlasStatistics {
    pub(super) fn of(tally: &Tally) -> Self {
        Self {
            tiles_rendered: tally.rendered,
            tiles_kept: tally.kept,
            tiles_empty: tally.empty,
            tiles_hidden: tally.hidden,
            tiles_postponed: tally.postponed,
            tiles_copied: tally.copied,
            static_tiles_drawn: tally.layers_drawn,
            casters_in_range: tally.casting,
            casters_out_of_range: tally.not_casting,
            ..Self::default()
        }
    }
}
