//! Errors of the sizes of tiles.

use thiserror::Error;

/// What can be wrong with a [`TileSize`](crate::map::TileSize), or with all of a frame's together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TileSizeError {
    /// A size that is not a power of two, smaller than the smallest tile, or larger than a layer.
    #[error(
        "{field} = {texels} is not a valid tile size; pass a power of two from {least} to {most}"
    )]
    Size {
        /// The field.
        field: &'static str,
        /// Its value.
        texels: u32,
        /// Texels along the smallest tile.
        least: u32,
        /// Texels along a layer.
        most: u32,
    },
    /// The smallest size is larger than the largest.
    #[error("TileSize::Auto has least = {least} over most = {most}; pass least <= most")]
    Order {
        /// The smallest size passed.
        least: u32,
        /// The largest size passed.
        most: u32,
    },
    /// The lights do not fit, even with each as small as allowed.
    #[error(
        "{lights} lights need {needed} texels even with each as small as allowed, but there are {bound}; allow more memory, smaller sizes, or fewer lights that cast"
    )]
    Space {
        /// Lights in the frame that cast.
        lights: usize,
        /// Texels they need.
        needed: u64,
        /// Texels there are.
        bound: u64,
    },
}
