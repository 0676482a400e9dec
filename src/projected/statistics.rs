//! What a frame of projected shadows took, for a host to show.

/// What the last [`ProjectedShadow::prepare`](crate::ProjectedShadow::prepare) found and the next `encode`
/// will do.
///
/// Each shadow of the frame is one of drawn, kept, empty and left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ProjectedStatistics {
    /// Shadows that will be drawn.
    pub shadows_drawn: u32,
    /// Shadows whose light and casters have not changed since they were drawn.
    pub shadows_kept: u32,
    /// Shadows without a caster.
    pub shadows_empty: u32,
    /// Shadows that cannot be drawn, and are lit: see [`ProjectorState`].
    pub shadows_left_out: u32,
    /// Draw calls, without those that clear tiles and make mip levels: one for each of the `passes`.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// Render passes: one for each layer, and one for each mip level of it.
    pub passes: u32,
    /// Layers of the texture.
    pub layers: u32,
    /// Texels in tiles, without mip levels.
    pub texels: u64,
    /// GPU memory held: texture and buffers, without the staging buffers in which `uploaded` waits.
    pub bytes: u64,
    /// Bytes that `encode` copies to the GPU: none where nothing has changed.
    pub uploaded: u64,
    /// Whether what the `prepare` before this one found necessary was never encoded: this one found it
    /// again. Of a host that prepares and encodes once a frame, always false.
    pub not_encoded: bool,
    /// Whether an encoder that an `encode` had recorded into was dropped instead of submitted, since
    /// the last `prepare`: everything is drawn again.
    pub encoder_dropped: bool,
}

/// What became of a shadow in the last [`ProjectedShadow::prepare`](crate::ProjectedShadow::prepare).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ProjectorState {
    /// Will be drawn by the next `encode`.
    Drawn,
    /// Is as it was.
    Kept,
    /// Nothing casts: all is lit.
    Empty,
    /// The light is among its casters: no square, up to 84 degrees to each side, holds them. All is
    /// lit. Give the casters to several projectors, or take a
    /// [`CubeShadowMap`](crate::CubeShadowMap).
    Surrounded,
    /// The light or a caster is so far away, so large or so small that the tile's matrix is not finite in
    /// `f32`. All is lit. Place all nearer the origin.
    BeyondF32,
}

impl ProjectedStatistics {
    pub(super) fn count(&mut self, state: ProjectorState) {
        let count = match state {
            ProjectorState::Drawn => &mut self.shadows_drawn,
            ProjectorState::Kept => &mut self.shadows_kept,
            ProjectorState::Empty => &mut self.shadows_empty,
            ProjectorState::Surrounded | ProjectorState::BeyondF32 => &mut self.shadows_left_out,
        };
        *count += 1;
    }
}
