//! Errors of shadow volumes and their light passes.

use std::num::NonZeroU32;

use thiserror::Error;

use super::CasterError;
use super::LightError;
use super::MultiviewError;
use super::names::names;

/// What can be wrong when a [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer) is made or
/// prepared.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShadowVolumeError {
    /// The depth-stencil format is not one that shadow volumes support.
    #[error(
        "{0:?} is unsuitable; shadow volumes need Depth24PlusStencil8 or Depth32FloatStencil8 (depth with an 8-bit stencil), or with Counter::Exact Depth32Float or Depth24Plus"
    )]
    Format(wgpu::TextureFormat),
    /// The device was created without the depth-stencil format.
    #[error(
        "{0:?} needs the device feature of that name: ask for Support::features() when the device is created, or use the format from Support::depth_stencil_format(), here and for the buffer itself"
    )]
    FormatFeature(wgpu::TextureFormat),
    /// The sample count is neither 1 nor 4.
    #[error("{0} samples are not supported; pass 1 or 4, which every device has")]
    SampleCount(u32),
    /// The device was created without a feature that the descriptor needs.
    #[error(
        "{needed_by} needs {}; ask for it when the device is created (see Support)",
        names(*feature)
    )]
    MissingFeature {
        /// What is missing.
        feature: wgpu::Features,
        /// What needs it, e.g. `"DepthConvention::Standard"`.
        needed_by: String,
    },
    /// A limit of the device is too low for any shadow volume.
    #[error(
        "the device's {name} is {available}, shadow volumes need {needed}; ask for more when the device is created (see Support)"
    )]
    Limit {
        /// The limit's name in [`wgpu::Limits`].
        name: &'static str,
        /// What is needed.
        needed: u64,
        /// What the device has.
        available: u64,
    },
    /// The device has storage buffers, but none in vertex shaders.
    #[error(
        "the device has no storage buffers in vertex shaders, which Silhouettes::Compute and Silhouettes::Cpu need; pass Silhouettes::Auto or Silhouettes::Vertex"
    )]
    VertexStorage,
    /// A colour format that the pass's target cannot have.
    #[error(
        "color_formats[{place}] is {format:?}, which this device cannot draw into with this number of samples; pass a colour format that it can (with 4 samples, one that is multisampled)"
    )]
    ColorFormat {
        /// Place in the list of colour formats.
        place: usize,
        /// The format found there.
        format: wgpu::TextureFormat,
    },
    /// The view was made with another depth convention than the renderer.
    #[error("the view's depth is {view:?}, this renderer was made for {renderer:?}")]
    Depth {
        /// The renderer's convention.
        renderer: crate::DepthConvention,
        /// The view's convention.
        view: crate::DepthConvention,
    },
    /// The light or its range is invalid.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A caster is invalid.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// Views that are to be drawn together.
    #[error(transparent)]
    Multiview(#[from] MultiviewError),
    /// The volume of one caster does not fit the device's buffers.
    #[error(
        "caster {index}: its {what} need {size} bytes in one buffer, {limit} are allowed; split the mesh or ask for higher buffer limits"
    )]
    TooLarge {
        /// Place in the slice of casters.
        index: usize,
        /// `"facings"`, `"caps"`, `"sides"` or `"edge records"`.
        what: &'static str,
        /// Bytes needed.
        size: u64,
        /// Bytes possible.
        limit: u64,
    },
    /// The target size has no pixels.
    #[error("a target of {0:?} pixels has none; pass its width and height, or None")]
    TargetSize([u32; 2]),
    /// The bounds of the receivers are not a valid box.
    #[error("receivers from {min:?} to {max:?} are not a box; pass finite corners, min <= max")]
    Receivers {
        /// The smallest corner passed.
        min: [f32; 3],
        /// The largest corner passed.
        max: [f32; 3],
    },
    /// The positions are in a buffer of the host, where the CPU cannot read them.
    #[error(
        "caster {index}: its positions are in the host's buffer, and only Silhouettes::Compute reads them there; create the mesh with CasterMesh::new, or use a renderer that may use compute shaders"
    )]
    HostPositions {
        /// Place in the slice of casters.
        index: usize,
    },
    /// A mesh for shadow maps only.
    #[error(
        "caster {index}: its mesh was made without an adjacency (CasterMesh::from_host), which shadow volumes need to find its edges; create it with CasterMesh::new or from_host_positions, or use it with shadow maps only"
    )]
    NoAdjacency {
        /// Place in the slice of casters.
        index: usize,
    },
    /// More lights or views than the device's buffers can describe.
    #[error("{count} {what} are too many for one frame; this device's buffer limits allow {limit}")]
    TooMany {
        /// `"lights"` or `"views"`.
        what: &'static str,
        /// Their number.
        count: usize,
        /// The largest number that works.
        limit: usize,
    },
    /// More casters than the device's buffers can describe; those that two lights shine on count twice,
    /// as do those in two views.
    #[error(
        "{count} casters are too many for one frame; this device's buffer limits allow {limit}"
    )]
    TooManyCasters {
        /// Casters that would be drawn.
        count: usize,
        /// The largest count that works.
        limit: usize,
    },
}

/// Why [`ShadowVolumeRenderer::render`](crate::ShadowVolumeRenderer::render) draws nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum VolumeRenderError {
    /// The prepared data has not been encoded.
    #[error(
        "render was called before encode; call prepare, then encode, then render in every frame (and for every view)"
    )]
    NotEncoded,
    /// The recorded work never reached the GPU.
    #[error(
        "the encoder that encode recorded into was dropped and not submitted; call prepare and encode again"
    )]
    Dropped,
    /// The last prepared frame has no such light, or no such view.
    #[error(
        "light {light} in view {view} was not prepared: the frame had {lights} lights and {views} views (with a multiview mask: sets of views); pass indices into its lists"
    )]
    NoSuch {
        /// The light asked for.
        light: usize,
        /// The view asked for.
        view: usize,
        /// Lights of the frame.
        lights: usize,
        /// Views of the frame; with a multiview mask, sets of them.
        views: usize,
    },
    /// What draws into one view a pass is asked to show the volumes of several.
    #[error(
        "this renderer draws {0} views a pass (multiview_mask), and debug views and surveys are of one; prepare a renderer without a mask for them"
    )]
    Multiview(usize),
}

/// What can be wrong with a [`ShadowMask`](crate::ShadowMask), a
/// [`LightJoin`](crate::LightJoin) or an [`ExactCount`](crate::ExactCount).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ScreenPassError {
    /// A size or a number of layers.
    #[error("a {what} of {value} is out of range; pass 1 to {limit}, the device's limit")]
    Range {
        /// What it is, e.g. `"width"`.
        what: &'static str,
        /// Its value.
        value: u32,
        /// The largest that works.
        limit: u32,
    },
    /// The depth-stencil format is unsuitable, or the device was created without it.
    #[error(
        "{0:?} is unsuitable; pass Depth24PlusStencil8, or Depth32FloatStencil8 on a device with the feature of that name"
    )]
    Format(wgpu::TextureFormat),
    /// The colour format cannot be drawn into and blended on this device, with as many samples.
    #[error(
        "{0:?} does not blend on this device with as many samples; pass a colour format that does"
    )]
    ColorFormat(wgpu::TextureFormat),
    /// The sample count is neither 1 nor 4.
    #[error("{0} samples are not supported; pass 1 or 4, which every device has")]
    SampleCount(u32),
    /// Shaders would have to read several samples, on a back end that cannot.
    #[error(
        "{what} with {samples} samples reads a multisampled texture, which wgpu's GL back end does not make; pass 1 sample, or count into a ShadowMask"
    )]
    SamplesOnGl {
        /// The samples passed.
        samples: u32,
        /// What would read them, e.g. `"LightJoin"`.
        what: &'static str,
    },
    /// The stencil is asked for, and the buffer has none.
    #[error(
        "{0:?} has no stencil to mark what is in shadow in; read the counts in the lighting shader (wgsl::EXACT), or fill a mask by ShadowMask::encode_counts"
    )]
    NoStencil(wgpu::TextureFormat),
    /// A mask is to be filled from another counter than it was made for.
    #[error(
        "this mask was made for Counter::{0:?}; encode fills those of Counter::Stencil, encode_counts those of Counter::Exact"
    )]
    Counter(crate::Counter),
    /// The device was created without a feature that this needs.
    #[error(
        "{needed_by} needs {}; ask for it when the device is created (see Support)",
        names(*feature)
    )]
    MissingFeature {
        /// What is missing.
        feature: wgpu::Features,
        /// What needs it, e.g. `"ExactCount"`.
        needed_by: &'static str,
    },
    /// The source has another number of samples than the target.
    #[error("the source has {found} samples, the target {needed}; draw both with the same number")]
    Source {
        /// Samples of the source.
        found: u32,
        /// Samples of the target.
        needed: u32,
    },
    /// Shaders cannot read the source as they have to.
    #[error(
        "the source is {format:?} with {}; pass a format that shaders read as float, made with TEXTURE_BINDING",
        names(*usage)
    )]
    Unreadable {
        /// Its format.
        format: wgpu::TextureFormat,
        /// What it was made for.
        usage: wgpu::TextureUsages,
    },
    /// Layers are drawn into by a pass of several views, and have several samples.
    #[error(
        "{what} with a multiview_mask takes 1 sample a pixel, not {samples}; make one without a mask, and use it for one layer after another"
    )]
    LayeredSamples {
        /// The samples passed.
        samples: u32,
        /// What was to be made, e.g. `"ExactCount"`.
        what: &'static str,
    },
    /// A texture has no layer for a view.
    #[error(
        "the texture has {found} layers, the multiview_mask needs {needed}; make it with as many"
    )]
    Layers {
        /// Its layers.
        found: u32,
        /// Layers needed.
        needed: u32,
    },
    /// Counts of other views than are needed.
    #[error(
        "the counts were made with the multiview_mask {found:?}, what reads them with {needed:?}; make both with the same"
    )]
    Multiview {
        /// Of the counts.
        found: Option<NonZeroU32>,
        /// What is needed.
        needed: Option<NonZeroU32>,
    },
    /// There is no layer for this light.
    #[error("light {light} has no layer; the mask was made for {lights}")]
    Layer {
        /// The light.
        light: u32,
        /// Layers.
        lights: u32,
    },
    /// The depth-stencil buffer is not the one that was announced.
    #[error(
        "the depth-stencil buffer is {found:?} (width, height, samples) of {found_format:?}; this was made for {needed:?} of {needed_format:?}"
    )]
    Buffer {
        /// Its width, height and samples.
        found: [u32; 3],
        /// Its format.
        found_format: wgpu::TextureFormat,
        /// Width, height and samples needed.
        needed: [u32; 3],
        /// Format needed.
        needed_format: wgpu::TextureFormat,
    },
}
