//! What a frame of planar shadows came to.

/// What the last [`PlanarShadow::prepare`](crate::PlanarShadow::prepare) found, for all lights, planes and views
/// together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PlanarStatistics {
    /// Casters drawn, each counted once for every light and plane.
    pub casters_drawn: u32,
    /// Those of them that may reach behind the plane or as high as the light, of which the fragment shader cuts
    /// off what casts nothing.
    pub casters_cut: u32,
    /// Casters left out that are behind the plane, or behind the light as seen from it.
    pub casters_behind: u32,
    /// Casters left out that are beyond the light's range.
    pub casters_beyond: u32,
    /// Casters left out because their place in the plane's frame is not finite in `f32`.
    pub casters_not_finite: u32,
    /// Pairs of a light and a plane that the light is behind, or in: it casts nothing there.
    pub lights_behind: u32,
    /// Draw calls that [`render`](crate::PlanarShadow::render) records for one view: casters, and polygons.
    pub draws: u32,
    /// Triangles of casters in them.
    pub triangles: u64,
    /// Bytes of GPU memory held.
    pub bytes: u64,
    /// Bytes that [`encode`](crate::PlanarShadow::encode) copies: 0 where nothing moved.
    pub uploaded: u64,
    /// Whether what the `prepare` before this one found was never encoded, and is found again.
    pub not_encoded: bool,
    /// Whether the encoder that was recorded into before was dropped, and everything is uploaded again.
    pub encoder_dropped: bool,
}
