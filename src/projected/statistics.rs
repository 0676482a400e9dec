//! Per-frame statistics of projected shadows, for a host to display.

/// The result of the last [`ProjectedShadow::prepare`](crate::ProjectedShadow::prepare), which the next
/// `encode` will carry out.
///
/// Each shadow of the frame is drawn, kept, empty or left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ProjectedStatistics {
    /// Shadows that will be drawn.
    pub shadows_drawn: u32,
    /// Shadows whose light and casters have not changed since they were drawn.
    pub shadows_kept: u32,
    /// Shadows without a caster.
    pub shadows_empty: u32,
    /// Shadows that are missing because they cannot be drawn: see [`ProjectorState`].
    pub shadows_left_out: u32,
    /// Draw calls, without those that clear tiles and generate mip levels, of which there is one for each of
    /// the `passes`.
    pub draws: u32,
    /// Triangles in those draws.
    pub triangles: u64,
    /// Render passes: one for each layer, and one for each mip level of it.
    pub passes: u32,
    /// Layers of the texture.
    pub layers: u32,
    /// Texels in tiles, without mip levels.
    pub texels: u64,
    /// GPU memory held by the texture and buffers, without staging buffers for uploads.
    pub bytes: u64,
    /// Bytes that `encode` copies to the GPU; 0 if nothing has changed.
    pub uploaded: u64,
    /// Whether the result of the previous `prepare` was never encoded, so that this one found the same work
    /// again. Always false for a host that prepares and encodes once per frame.
    pub not_encoded: bool,
    /// Whether an encoder that `encode` had recorded into was dropped instead of submitted since the last
    /// `prepare`, so that everything is redrawn.
    pub encoder_dropped: bool,
}

/// The state of a shadow after the last [`ProjectedShadow::prepare`](crate::ProjectedShadow::prepare).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ProjectorState {
    /// Will be drawn by the next `encode`.
    Drawn,
    /// Has not changed.
    Kept,
    /// Has no casters: everything is lit.
    Empty,
    /// The light is among its casters: no square of up to 84 degrees to each side contains them. Everything
    /// is lit. Split the casters among several projectors, or use a [`CubeShadowMap`](crate::CubeShadowMap).
    Surrounded,
    /// The light or a caster is so far away, so large or so small that the tile's matrix is not finite in
    /// `f32`. Everything is lit. Move the scene nearer to the origin.
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
