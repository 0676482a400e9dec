//! Errors of light maps.

use thiserror::Error;

use super::LightError;
use crate::reference::bake::TexelRectangle;

/// What can be wrong with the input of [`reference::bake`](crate::reference::bake).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LightMapError {
    /// The map has no texels, or too many along a side.
    #[error("a light map of {} x {} texels is out of range; pass 1 to 8192 each", .0[0], .0[1])]
    Size([u32; 2]),
    /// A receiver's rectangle is empty or not inside the map.
    #[error(
        "receiver {receiver}: {rectangle:?} is not part of a map of {} x {} texels; pass at least one texel, within the map",
        size[0], size[1]
    )]
    Place {
        /// Place in the list of receivers.
        receiver: usize,
        /// What was passed.
        rectangle: TexelRectangle,
        /// Columns and rows of the map.
        size: [u32; 2],
    },
    /// Two receivers share texels.
    #[error(
        "receivers {} and {} have rectangles with texels in common; give each its own",
        receivers[0], receivers[1]
    )]
    PlacesOverlap {
        /// Places in the list of receivers.
        receivers: [usize; 2],
    },
    /// The number of indices is not a multiple of three.
    #[error("receiver {receiver}: {count} indices are not a multiple of 3; pass 3 per triangle")]
    IndexCount {
        /// Place in the list of receivers.
        receiver: usize,
        /// Length of its index list.
        count: usize,
    },
    /// An index points past the last vertex.
    #[error(
        "receiver {receiver}, triangle {triangle}: index {index} is out of range, there are {vertices} vertices"
    )]
    IndexOutOfRange {
        /// Place in the list of receivers.
        receiver: usize,
        /// Triangle, counted as its indices are.
        triangle: usize,
        /// The index found there.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A position is not finite in world space: the vertex or the transform is NaN, infinite or
    /// too large.
    #[error(
        "receiver {receiver}: vertex {vertex} has no finite position in the world; check it and the transform"
    )]
    Position {
        /// Place in the list of receivers.
        receiver: usize,
        /// The vertex.
        vertex: u32,
    },
    /// There is not one pair of texture coordinates for each vertex.
    #[error(
        "receiver {receiver}: {uvs} texture coordinates for {vertices} vertices; pass one pair each, unwrapped for light maps"
    )]
    UvCount {
        /// Place in the list of receivers.
        receiver: usize,
        /// How many were passed.
        uvs: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A texture coordinate is NaN or outside 0 to 1.
    #[error(
        "receiver {receiver}, triangle {triangle}: texture coordinates {uv:?} are outside 0 to 1; light maps do not repeat"
    )]
    Uv {
        /// Place in the list of receivers.
        receiver: usize,
        /// Triangle, counted as its indices are.
        triangle: usize,
        /// Of one of its corners.
        uv: [f32; 2],
    },
    /// A triangle with an area in the world has none in texture coordinates.
    #[error(
        "receiver {receiver}, triangle {triangle}: its texture coordinates lie on a line, so it has no texels; unwrap it"
    )]
    UvNoArea {
        /// Place in the list of receivers.
        receiver: usize,
        /// Triangle, counted as its indices are.
        triangle: usize,
    },
    /// Two triangles overlap in the map.
    #[error(
        "receiver {receiver}: triangles {} and {} overlap in texture coordinates; each needs its own place in a light map",
        triangles[0], triangles[1]
    )]
    UvOverlap {
        /// Place in the list of receivers.
        receiver: usize,
        /// Triangles, counted as its indices are.
        triangles: [usize; 2],
    },
    /// More receivers or triangles than 32-bit numbers can count.
    #[error("{0} receivers or triangles are too many; at most 2^32 - 3 are possible")]
    TooLarge(usize),
    /// The light is invalid.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The radius of a spherical light is out of range.
    #[error("light radius {0} is out of range; pass a finite number above 0, or Emitter::Point")]
    Radius(f32),
    /// The sides of a rectangular light are invalid.
    #[error(
        "half_sides {half_sides:?} do not form a rectangle around a point light or a spot; pass finite sides that are not parallel, and a sphere for a directional light"
    )]
    Rectangle {
        /// What was passed.
        half_sides: [[f32; 3]; 2],
    },
    /// No rays.
    #[error("0 samples see nothing; pass at least 1 a texel")]
    Samples,
    /// An image for no light, or for more lights than channels.
    #[error("{0} light maps for one image; pass 1 to 4")]
    Channels(usize),
    /// Maps of one image have different sizes.
    #[error(
        "light maps of {} x {} and {} x {} texels do not fit one image; bake them with one layout",
        .0[0][0], .0[0][1], .0[1][0], .0[1][1]
    )]
    OtherSize([[u32; 2]; 2]),
}
