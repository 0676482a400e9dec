//! Errors of the atlas.

use thiserror::Error;

use super::{CascadeError, CasterError, LightError, MapSettingsError, TileSizeError};

/// What can be wrong with a [`ShadowAtlas`](crate::ShadowAtlas) or a frame of it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShadowAtlasError {
    /// The size of layers is not a power of two, or out of the device's range.
    #[error("layer_size = {size} is out of range; pass a power of two from {least} to {limit}")]
    LayerSize {
        /// Texels along a side.
        size: u32,
        /// Texels along the smallest tile.
        least: u32,
        /// The largest that works.
        limit: u32,
    },
    /// Not one layer fits.
    #[error(
        "memory = {memory} bytes holds no layer, which takes {layer}; pass more, or a smaller layer_size"
    )]
    Memory {
        /// Bytes allowed.
        memory: u64,
        /// Bytes of a layer.
        layer: u64,
    },
    /// A budget of no tile at all.
    #[error("max_tiles_per_frame is 0, so nothing would ever be drawn; pass at least 1, or None")]
    Budget,
    /// The settings are out of range.
    #[error(transparent)]
    Settings(#[from] MapSettingsError),
    /// A light is out of range.
    #[error("light {index}: {source}")]
    Light {
        /// Its place in the frame.
        index: usize,
        /// What is wrong with it.
        source: LightError,
    },
    /// A light's sizes are out of range.
    #[error("light {index}: {source}")]
    TileSize {
        /// Its place in the frame.
        index: usize,
        /// What is wrong with them.
        source: TileSizeError,
    },
    /// A directional light's cascades are out of range.
    #[error("light {index}: {source}")]
    Cascades {
        /// Its place in the frame.
        index: usize,
        /// What is wrong with them.
        source: CascadeError,
    },
    /// A view's picture has no pixels.
    #[error("view {index} fills a picture of {width} x {height} pixels; pass at least 1 x 1")]
    Pixels {
        /// Its place in the frame.
        index: usize,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The depths that a view shows are out of range.
    #[error("view {index}: {source}")]
    DepthBounds {
        /// Its place in the frame.
        index: usize,
        /// What is wrong with them.
        source: CascadeError,
    },
    /// The receivers' bounds are out of range.
    #[error(
        "receivers from {min:?} to {max:?} are not a box; pass finite corners, min no greater than max"
    )]
    Receivers {
        /// The corner with the least coordinates.
        min: [f32; 3],
        /// The corner with the greatest coordinates.
        max: [f32; 3],
    },
    /// The tiles do not fit, even with each as small as allowed.
    #[error(transparent)]
    Space(TileSizeError),
    /// More lights than shaders of the device can read.
    #[error(
        "{records} records of lights, one for each light, view and cascade, are out of range; shaders of this device can read {limit}"
    )]
    TooManyLights {
        /// Records needed.
        records: usize,
        /// The most that work.
        limit: usize,
    },
    /// More lights than one buffer of the device can hold the matrices of: 256 bytes for each of the 8 tiles that a
    /// light may have.
    #[error(
        "{lights} lights, directional ones counted once for each view, need {size} bytes for their tiles' matrices, {limit} are allowed in one buffer (max_buffer_size); pass fewer lights, or ask for more when the device is created"
    )]
    TooManyMatrices {
        /// Lights, a directional one once for each view.
        lights: usize,
        /// Bytes needed.
        size: u64,
        /// Bytes possible.
        limit: u64,
    },
    /// A caster is out of range.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// More casters than one buffer of the device can hold.
    #[error("{instances} casters on tiles need {size} bytes, max_buffer_size is {limit}")]
    TooManyCasters {
        /// Casters, each counted once for every tile it touches.
        instances: usize,
        /// Bytes needed.
        size: u64,
        /// Bytes allowed.
        limit: u64,
    },
    /// A light or a caster is so far away that a directional light's matrix is not finite.
    #[error(
        "light {index}: its matrix is not finite in f32; a caster or the receivers are too far away, too large or too small: move the scene nearer to the origin"
    )]
    BeyondF32 {
        /// The light's place in the frame.
        index: usize,
    },
}
