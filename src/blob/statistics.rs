//! Per-frame statistics of blob shadows.

/// The result of the last [`BlobShadow::prepare`](crate::BlobShadow::prepare).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct BlobStatistics {
    /// Blobs in the frame: casters and ellipsoids.
    pub blobs: u32,
    /// Those that cast nothing: without an area, of opacity 0, too large (1e16) or too small for shaders to
    /// compute with in `f32`, or casters whose centre overflows `f32`.
    pub without_shadow: u32,
    /// Blobs whose ellipsoid has changed: only these are computed and uploaded.
    pub changed: u32,
    /// Bytes that [`encode`](crate::BlobShadow::encode) copies to the GPU; 0 if nothing has changed.
    pub uploaded: u64,
    /// GPU memory held: 64 bytes per blob, rounded up to a power of two, and 256 for each light and view.
    pub bytes: u64,
    /// Whether the result of the previous `prepare` was never encoded, so that everything is uploaded again.
    pub not_encoded: bool,
    /// Whether an encoder that `encode` had recorded into was dropped instead of submitted since the last
    /// `prepare`, so that everything is uploaded again.
    pub encoder_dropped: bool,
}
