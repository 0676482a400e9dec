//! Per-frame statistics, for a host to display.

use std::time::Duration;

use super::one_light::Taken;

/// The result of the last [`CubeShadowMap::prepare`](crate::CubeShadowMap::prepare), which the next `encode`
/// will carry out.
///
/// Each of the six faces is rendered, kept, empty or hidden.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct CubeStatistics {
    /// Faces that will be drawn, or cleared because their last caster left.
    pub faces_rendered: u32,
    /// Faces with casters whose content has not changed since they were drawn.
    pub faces_kept: u32,
    /// Faces without a caster that are already clear.
    pub faces_empty: u32,
    /// Faces that changed but can hold no receiver that the view shows.
    pub faces_hidden: u32,
    /// Faces that [`encode`](crate::CubeShadowMap::encode) has drawn without the casters that only the host
    /// can draw: 0 before it, and after [`encode_with`](crate::CubeShadowMap::encode_with).
    pub faces_incomplete: u32,
    /// The subset of `faces_rendered` whose static casters are copied from a second layer
    /// ([`StaticLayers`](crate::StaticLayers)) rather than drawn.
    pub faces_copied: u32,
    /// Second layers that are drawn in this frame, to be copied in this one and later ones.
    pub layers_drawn: u32,
    /// Casters that touch a face.
    pub casters_in_range: u32,
    /// Casters beyond the light's range.
    pub casters_out_of_range: u32,
    /// Draw calls.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
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

/// The state of a tile (a face of a point light, a spot's map, a cascade) after the last `prepare`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TileState {
    /// Will be drawn or cleared by the next `encode`.
    Rendered,
    /// Has casters and is up to date.
    Kept,
    /// Has no casters and is clear, or has no texels.
    #[default]
    Empty,
    /// Changed, but can hold no receiver that the view shows.
    Hidden,
    /// Changed, but waits for the budget of a later frame.
    Postponed,
}

/// One tile of one light after the last `prepare`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct TileStatistics {
    /// Its state.
    pub state: TileState,
    /// Casters that touch it.
    pub casters: u32,
    /// Their triangles.
    pub triangles: u64,
    /// Frames it has waited to be drawn, including this one.
    pub age: u32,
}

/// The result of the last [`ShadowMap::prepare`](crate::ShadowMap::prepare), which the next `encode` will
/// carry out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShadowMapStatistics {
    /// Whether the map will be drawn or cleared; false if it is already up to date.
    pub rendered: bool,
    /// Whether [`encode`](crate::ShadowMap::encode) has drawn it without the casters that only the host can
    /// draw: false before it, and after [`encode_with`](crate::ShadowMap::encode_with).
    pub incomplete: bool,
    /// Casters on the map.
    pub casters_drawn: u32,
    /// Casters that cannot be on the map.
    pub casters_outside: u32,
    /// Draw calls.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// GPU memory held: texture and buffers, without the staging buffers in which `uploaded` waits:
    /// these are kept, of powers of two from 64 KB on, as many as frames wait for the GPU.
    pub bytes: u64,
    /// Bytes that `encode` copies to the GPU; 0 if nothing has changed.
    pub uploaded: u64,
    /// Whether the result of the previous `prepare` was never encoded, so that this one found the same work
    /// again. Always false for a host that prepares and encodes once per frame.
    pub not_encoded: bool,
    /// Whether an encoder that `encode` had recorded into was dropped instead of submitted since the last
    /// `prepare`, so that the map is redrawn.
    pub encoder_dropped: bool,
    /// CPU time of `prepare`. Zero on the web, where the standard library has no clock.
    pub prepare: Duration,
}

impl CubeStatistics {
    pub(super) fn of(taken: &Taken) -> Self {
        let tally = &taken.tally;
        Self {
            faces_rendered: tally.rendered,
            faces_kept: tally.kept,
            faces_empty: tally.empty,
            faces_hidden: tally.hidden,
            faces_incomplete: 0,
            faces_copied: tally.copied,
            layers_drawn: tally.layers_drawn,
            casters_in_range: tally.casting,
            casters_out_of_range: tally.not_casting,
            draws: taken.draws,
            triangles: taken.triangles,
            bytes: taken.bytes,
            uploaded: taken.uploaded,
            not_encoded: taken.not_encoded,
            encoder_dropped: taken.encoder_dropped,
            prepare: taken.prepare,
        }
    }
}

impl ShadowMapStatistics {
    pub(super) fn of(taken: &Taken) -> Self {
        Self {
            rendered: taken.tally.rendered > 0,
            incomplete: false,
            casters_drawn: taken.tally.casting,
            casters_outside: taken.tally.not_casting,
            draws: taken.draws,
            triangles: taken.triangles,
            bytes: taken.bytes,
            uploaded: taken.uploaded,
            not_encoded: taken.not_encoded,
            encoder_dropped: taken.encoder_dropped,
            prepare: taken.prepare,
        }
    }
}
