//! Errors of blob shadows.

use thiserror::Error;

use super::names::names;
use super::{CasterError, LightError};

/// What can be wrong when a [`BlobShadow`](crate::BlobShadow) is made, prepared or given a depth texture.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BlobShadowError {
    /// A number in the descriptor is out of range.
    #[error("{value} {what} are out of range; pass 1 to {limit}")]
    Range {
        /// `"lights"`, `"views"` or `"strips"`.
        what: &'static str,
        /// Its value.
        value: u32,
        /// The largest that works.
        limit: u32,
    },
    /// Receivers read blobs, but the device has no storage buffers.
    #[error(
        "the device has no storage buffers, which shaders need to read the blobs; set `receivers` to false and draw decals"
    )]
    NoStorage,
    /// Decals cannot be drawn into this target format, or not blended there.
    #[error("{0:?} cannot be drawn into and blended on this device; pass a colour format that can")]
    TargetFormat(wgpu::TextureFormat),
    /// The attachment's format has neither depth nor stencil, or the device lacks its feature.
    #[error(
        "depth_stencil_format is {0:?}; pass the format of the pass's depth-stencil attachment, or None if it has none"
    )]
    DepthFormat(wgpu::TextureFormat),
    /// The depth texture cannot be read.
    #[error(
        "the depth texture is {format:?} of {samples} samples and {layers} layers with {}; pass one with depth, of one sample and one layer, made with TEXTURE_BINDING (of several samples: resolve it, or use the function in your shader)",
        names(*usage)
    )]
    Depth {
        /// Its format.
        format: wgpu::TextureFormat,
        /// What it was made for.
        usage: wgpu::TextureUsages,
        /// Its samples per pixel.
        samples: u32,
        /// Its layers.
        layers: u32,
    },
    /// The descriptor requested no decals.
    #[error("no decals were asked for; set `decals` in the BlobShadowDescriptor")]
    NoDecals,
    /// More lights or views than the descriptor allows.
    #[error(
        "the frame has {count} {what}, the BlobShadow was made for {limit}; raise `{what}` in its descriptor"
    )]
    TooMany {
        /// `"lights"` or `"views"`.
        what: &'static str,
        /// Their number.
        count: usize,
        /// What the descriptor said.
        limit: u32,
    },
    /// More blobs than the device's buffers hold.
    #[error("{count} casters and blobs are too many; this device's buffer limits allow {limit}")]
    TooManyBlobs {
        /// Their number.
        count: usize,
        /// The largest number that works.
        limit: u64,
    },
    /// A light's position or direction is invalid.
    #[error("light {index}: {error}")]
    Light {
        /// Place in the frame's lights.
        index: usize,
        /// What is wrong.
        error: LightError,
    },
    /// A light's size is invalid.
    #[error(
        "light {index}: its radius {radius} is out of range; pass a finite radius of at least 0"
    )]
    Radius {
        /// Place in the frame's lights.
        index: usize,
        /// The radius passed.
        radius: f32,
    },
    /// A light's reach is out of range.
    #[error("light {index}: its reach {reach} is out of range; pass a finite distance above 0")]
    Reach {
        /// Place in the frame's lights.
        index: usize,
        /// The reach passed.
        reach: f32,
    },
    /// A caster is invalid.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// An ellipsoid with a number that is NaN or infinite.
    #[error("blob {index}: its centre or an axis is not finite")]
    Blob {
        /// Place in the frame's blobs.
        index: usize,
    },
    /// An ellipsoid's opacity is outside 0 to 1.
    #[error("blob {index}: its opacity {opacity} is out of range; pass 0 to 1")]
    Opacity {
        /// Place in the frame's blobs.
        index: usize,
        /// The opacity passed.
        opacity: f32,
    },
}

/// Why [`BlobShadow::render`](crate::BlobShadow::render) draws nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BlobRenderError {
    /// The descriptor requested no decals.
    #[error("no decals were asked for; set `decals` in the BlobShadowDescriptor")]
    NoDecals,
    /// The prepared data has not been encoded, or nothing has been prepared since `new` or `invalidate`.
    #[error(
        "render was called before encode; call prepare, then encode, then render in every frame"
    )]
    NotEncoded,
    /// The recorded work never reached the GPU.
    #[error(
        "the encoder that encode recorded into was dropped and not submitted; call prepare and encode again"
    )]
    Dropped,
    /// The last prepared frame has no such light, or no such view.
    #[error(
        "light {light} in view {view} was not prepared: the frame had {lights} lights and {views} views; pass indices into its lists"
    )]
    NoSuch {
        /// The light asked for.
        light: usize,
        /// The view asked for.
        view: usize,
        /// Lights of the frame.
        lights: usize,
        /// Views of the frame.
        views: usize,
    },
}
