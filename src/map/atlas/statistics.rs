//! Per-frame statistics of an atlas, for a host to display.

use std::time::Duration;

use crate::map::plan::Tally;

/// The result of the last [`ShadowAtlas::prepare`](crate::ShadowAtlas::prepare), which the next `encode` will
/// carry out.
///
/// Each tile of each light in the frame is rendered, kept, empty, hidden or postponed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct AtlasStatistics {
    /// Tiles that will be drawn, or cleared because their last caster left.
    pub tiles_rendered: u32,
    /// Tiles with casters whose content has not changed since they were drawn.
    pub tiles_kept: u32,
    /// Tiles without casters that are already clear or have no texels.
    pub tiles_empty: u32,
    /// Tiles that changed but can hold no receiver that a view shows.
    pub tiles_hidden: u32,
    /// Tiles that changed but wait for the budget of a later frame.
    pub tiles_postponed: u32,
    /// The subset of `tiles_rendered` whose static casters are copied from a second layer
    /// ([`StaticLayers`](crate::StaticLayers)) rather than drawn.
    pub tiles_copied: u32,
    /// Tiles of second layers that are drawn in this frame, to be copied in this one and later ones.
    pub static_tiles_drawn: u32,
    /// Tiles that the last `encode` drew without the casters that only the host can draw, because it was
    /// called instead of [`ShadowAtlas::encode_with`](crate::ShadowAtlas::encode_with). They are redrawn in
    /// the next frame.
    pub tiles_incomplete: u32,
    /// Lights whose tiles are smaller than requested for lack of space.
    pub lights_reduced: u32,
    /// Lights whose tiles are redrawn because their size or place changed.
    pub lights_moved: u32,
    /// Casters that touch a tile, counted once for each light.
    pub casters_in_range: u32,
    /// Casters that touch no tile, counted once for each light.
    pub casters_out_of_range: u32,
    /// Draw calls.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// Layers of the texture.
    pub layers: u32,
    /// Texels in all tiles.
    pub texels: u64,
    /// GPU memory held by textures and buffers. Not included are staging buffers for uploads: they are kept,
    /// in sizes of powers of two from 64 KB, as many as there are frames in flight.
    pub bytes: u64,
    /// Bytes that `encode` copies to the GPU; 0 if nothing has changed.
    pub uploaded: u64,
    /// Whether the result of the previous `prepare` was never encoded, so that this one found the same work
    /// again. Always false for a host that prepares and encodes once per frame.
    pub not_encoded: bool,
    /// Whether an encoder that `encode` had recorded into was dropped instead of submitted since the last
    /// `prepare`, so that everything is redrawn.
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
