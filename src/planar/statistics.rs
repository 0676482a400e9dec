//! Per-frame statistics of planar shadows.

/// The result of the last [`PlanarShadow::prepare`](crate::PlanarShadow::prepare), for all lights, planes and
/// views together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PlanarStatistics {
    /// Casters drawn, each counted once per light and plane.
    pub casters_drawn: u32,
    /// The subset that may reach behind the plane or above the light, where the fragment shader discards the
    /// parts that cast nothing.
    pub casters_cut: u32,
    /// Casters left out because they are behind the plane, or behind the light as seen from the plane.
    pub casters_behind: u32,
    /// Casters left out because they are beyond the light's range.
    pub casters_beyond: u32,
    /// Casters left out because their coordinates relative to the plane are not finite in `f32`.
    pub casters_not_finite: u32,
    /// Pairs of a plane and a light that is behind or in that plane, and so casts nothing there.
    pub lights_behind: u32,
    /// Draw calls that [`render`](crate::PlanarShadow::render) records for one view: casters, and polygons.
    pub draws: u32,
    /// Triangles of casters in those draws.
    pub triangles: u64,
    /// Bytes of GPU memory held.
    pub bytes: u64,
    /// Bytes that [`encode`](crate::PlanarShadow::encode) copies; 0 if nothing has moved.
    pub uploaded: u64,
    /// Whether the result of the previous `prepare` was never encoded, so that this one found the same work
    /// again.
    pub not_encoded: bool,
    /// Whether the encoder that was last recorded into was dropped, so that everything is uploaded again.
    pub encoder_dropped: bool,
}
