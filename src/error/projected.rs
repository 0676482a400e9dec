//! Errors of projected shadows.

use thiserror::Error;

use super::{CasterError, LightError};

/// What can be wrong with a [`ProjectedShadow`](crate::ProjectedShadow) or with its frame.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ProjectedShadowError {
    /// The size of layers is not a power of two, or out of range.
    #[error(
        "layer_size = {size} texels is out of range; pass a power of two from {least} to {limit}"
    )]
    LayerSize {
        /// Texels along a side.
        size: u32,
        /// The smallest that works.
        least: u32,
        /// The largest that works.
        limit: u32,
    },
    /// Not enough memory for one layer.
    #[error("memory = {memory} bytes is less than one layer needs: {layer} bytes")]
    Memory {
        /// Bytes allowed.
        memory: u64,
        /// Bytes of a layer.
        layer: u64,
    },
    /// The size of a tile is not a power of two, or out of range.
    #[error(
        "projector {projector}: a tile of {size} texels; pass a power of two from {least} to {most}, the layer's size"
    )]
    Size {
        /// Its place in the frame.
        projector: usize,
        /// Texels along a side.
        size: u32,
        /// The smallest that works.
        least: u32,
        /// The largest that works.
        most: u32,
    },
    /// A light is out of range.
    #[error("projector {projector}: {source}")]
    Light {
        /// Its projector's place in the frame.
        projector: usize,
        /// What is wrong with it.
        source: LightError,
    },
    /// A caster is out of range.
    #[error("projector {projector}: {source}")]
    Caster {
        /// Its projector's place in the frame.
        projector: usize,
        /// What is wrong with it, and its place among the projector's casters.
        source: CasterError,
    },
    /// Geometry that only the host can draw.
    #[error(
        "projector {projector}: caster {caster} is drawn by the host (CasterMesh::host_drawn), which is not asked to here; leave it out, or pass its triangles"
    )]
    HostDrawn {
        /// Its projector's place in the frame.
        projector: usize,
        /// Its place among the projector's casters.
        caster: usize,
    },
    /// A caster's transmittance is outside 0 to 1.
    #[error(
        "projector {projector}: caster {caster} lets {transmittance:?} of red, green and blue light through; pass 0 to 1 for each"
    )]
    Transmittance {
        /// Its projector's place in the frame.
        projector: usize,
        /// Its place among the projector's casters.
        caster: usize,
        /// What was passed.
        transmittance: [f32; 3],
    },
    /// The tiles do not fit.
    #[error(
        "{shadows} shadows need {needed} texels, but there are {bound}; allow more memory, smaller sizes, or fewer shadows"
    )]
    Space {
        /// Shadows in the frame that have a tile.
        shadows: usize,
        /// Texels they need.
        needed: u64,
        /// Texels there are.
        bound: u64,
    },
    /// More projectors than the device's shaders can read.
    #[error("{projectors} projectors are out of range; shaders of this device can read {limit}")]
    TooManyProjectors {
        /// Projectors in the frame.
        projectors: usize,
        /// The most that work.
        limit: usize,
    },
    /// More casters than one buffer of the device can hold.
    #[error("{casters} casters need {size} bytes, max_buffer_size is {limit}")]
    TooManyCasters {
        /// Casters of all projectors.
        casters: usize,
        /// Bytes needed.
        size: u64,
        /// Bytes allowed.
        limit: u64,
    },
}
