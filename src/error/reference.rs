//! Errors of the reference.

use std::ops::Range;

use thiserror::Error;

use super::LightError;

/// What can be wrong with the input of [`reference`](crate::reference).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// The number of indices is not a multiple of three.
    #[error("object {object}: {count} indices are not a multiple of 3; pass 3 per triangle")]
    IndexCount {
        /// Place in the list of objects.
        object: usize,
        /// Length of its index list.
        count: usize,
    },
    /// An index points past the last vertex.
    #[error("object {object}: index {index} is out of range, it has {vertices} vertices")]
    IndexOutOfRange {
        /// Place in the list of objects.
        object: usize,
        /// The index found there.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A position is not finite in world space: the vertex or the transform is NaN, infinite or
    /// too large.
    #[error(
        "object {object}: vertex {vertex} has no finite position in the world; check it and the transform"
    )]
    Position {
        /// Place in the list of objects.
        object: usize,
        /// The vertex.
        vertex: u32,
    },
    /// More objects or triangles than 32-bit numbers can count.
    #[error("{0} objects or triangles are too many; at most 2^32 - 1 are possible")]
    TooLarge(usize),
    /// The light is invalid.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The picture has no pixels.
    #[error("a picture of {width} x {height} pixels is empty; pass at least 1 x 1")]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// No rows, or rows that the picture does not have.
    #[error("a picture of {height} rows has no rows {rows:?}; pass some of 0..{height}")]
    Rows {
        /// The rows asked for.
        rows: Range<u32>,
        /// Rows of the whole picture.
        height: u32,
    },
    /// Two frames to compare have different sizes.
    #[error(
        "the frame before has {} x {} pixels, this one {} x {}; render both at one size",
        before[0], before[1], now[0], now[1]
    )]
    OtherSize {
        /// Width and height of the frame before.
        before: [u32; 2],
        /// Width and height of this one.
        now: [u32; 2],
    },
    /// The picture to compare has another number of pixels.
    #[error("{passed} visibilities were passed for a picture of {pixels} pixels; pass one each")]
    VisibilityCount {
        /// How many were passed.
        passed: usize,
        /// Pixels of the reference.
        pixels: usize,
    },
    /// A visibility is NaN or outside 0 to 1.
    #[error("pixel {pixel} has the visibility {value}; pass 0 (in shadow) to 1 (lit)")]
    Visibility {
        /// Row-major number of the pixel.
        pixel: usize,
        /// What was passed.
        value: f32,
    },
    /// An impossible interior of shadow map texels.
    #[error(
        "an interior of {face_size} texels a face, kernel radius {kernel_radius}, is impossible; pass at least 1 texel, a finite radius of at least 0, and for cube maps a point light, for flat maps a finite matrix"
    )]
    Interior {
        /// Texels along the edge of a cube face or a flat map.
        face_size: u32,
        /// Radius of the filter in texels.
        kernel_radius: f32,
    },
    /// An impossible interior of light map texels.
    #[error(
        "an interior around texels of {0} is impossible; pass the side of a texel on the surface, a finite length above 0"
    )]
    Texel(f32),
}
