//! What blob shadows take.

/// What the last [`BlobShadow::prepare`](crate::BlobShadow::prepare) found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct BlobStatistics {
    /// Blobs of the frame: casters and ellipsoids.
    pub blobs: u32,
    /// Those that cast nothing: without an area, of opacity 0, so large (1e16) or so small that shaders cannot
    /// reckon with them in `f32`, or casters whose centre is beyond `f32`.
    pub without_shadow: u32,
    /// Blobs whose ellipsoid is not what it was: the only ones that are computed and uploaded.
    pub changed: u32,
    /// Bytes that [`encode`](crate::BlobShadow::encode) copies to the GPU: none where nothing has changed.
    pub uploaded: u64,
    /// GPU memory held: 64 bytes a blob, rounded up to a power of two, and 256 for each light and view.
    pub bytes: u64,
    /// Whether what the `prepare` before this one found was never encoded: all is uploaded again.
    pub not_encoded: bool,
    /// Whether an encoder that an `encode` had recorded into was dropped instead of submitted, since the last
    /// `prepare`: all is uploaded again.
    pub encoder_dropped: bool,
}
