//! Errors of planar shadows.

use thiserror::Error;

use super::{CasterError, LightError};

/// What can be wrong with a [`PlanarShadow`](crate::PlanarShadow) or a frame of it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PlanarShadowError {
    /// The depth-stencil format is not one of the two with both depth and stencil.
    #[error(
        "{0:?} is unsuitable; planar shadows need Depth24PlusStencil8 or Depth32FloatStencil8 (depth with an 8-bit stencil)"
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
    /// A colour format that the pass's target cannot have.
    #[error(
        "color_formats[{place}] is {format:?}, which this device cannot draw into with this number of samples; pass a colour format that it can"
    )]
    ColorFormat {
        /// Place in the list of colour formats.
        place: usize,
        /// The format found there.
        format: wgpu::TextureFormat,
    },
    /// More colour targets, or more bytes in them, than the device takes.
    #[error(
        "color_formats need {name} of {needed}, and the device has {available}; pass fewer or smaller formats, or ask for more when the device is created"
    )]
    ColorLimit {
        /// The limit's name in [`wgpu::Limits`].
        name: &'static str,
        /// What is needed.
        needed: u64,
        /// What the device has.
        available: u64,
    },
    /// The target to be darkened does not exist, or cannot be blended.
    #[error(
        "PlanarOutput::Darken needs a blendable format at color_formats[{target}], but found {found:?}; pass the index of a target that blends"
    )]
    Target {
        /// Place in the list of colour formats.
        target: usize,
        /// The format found there.
        found: Option<wgpu::TextureFormat>,
    },
    /// Stencil bits that are missing, several, or used twice.
    #[error(
        "stencil bits shadow {shadow:#04x}, outline {outline:#04x}, receivers {receivers:#04x} are invalid; pass one bit each for the first two, and receivers that share no bit with them"
    )]
    Bits {
        /// The bit that marks what is in shadow.
        shadow: u8,
        /// The bit that marks the inside of a polygon.
        outline: u8,
        /// The bits that the host marks receivers with.
        receivers: u8,
    },
    /// A bias that is not finite, or below 0.
    #[error("bias {field} = {value}; pass a finite number, at least 0")]
    Bias {
        /// The field.
        field: &'static str,
        /// Its value.
        value: f32,
    },
    /// A light is out of range.
    #[error("light {index}: {error}")]
    Light {
        /// Place in the frame's lights.
        index: usize,
        /// What is wrong with it.
        error: LightError,
    },
    /// A light's shade is outside 0 to 1.
    #[error("light {index}: shade {shade:?} is out of range; pass 0 (black) to 1 (no shadow)")]
    Shade {
        /// Place in the frame's lights.
        index: usize,
        /// What was passed.
        shade: [f32; 3],
    },
    /// An invalid plane.
    #[error(
        "plane {index}: point {point:?} and normal {normal:?} do not define a plane; pass finite numbers, and a normal other than (0, 0, 0)"
    )]
    Plane {
        /// Place in the frame's planes.
        index: usize,
        /// The point passed.
        point: [f32; 3],
        /// The normal passed.
        normal: [f32; 3],
    },
    /// A stencil value of 0, or one that the bits for receivers cannot hold.
    #[error(
        "plane {index}: stencil value {value:#04x} is invalid; pass the value that the host writes, other than 0, within receiver_bits = {receivers:#04x}"
    )]
    Value {
        /// Place in the frame's planes.
        index: usize,
        /// The value passed.
        value: u8,
        /// The descriptor's bits for receivers.
        receivers: u8,
    },
    /// An outline with too few corners.
    #[error("plane {index}: {corners} corners do not make an outline; pass at least 3")]
    Outline {
        /// Place in the frame's planes.
        index: usize,
        /// Corners passed.
        corners: usize,
    },
    /// A corner that is not finite, or not in the plane.
    #[error(
        "plane {index}: corner {corner} of its outline, {position:?}, is not in the plane; pass points on the plane (rounding errors are corrected)"
    )]
    Corner {
        /// Place in the frame's planes.
        index: usize,
        /// Place in the outline.
        corner: usize,
        /// The corner passed.
        position: [f32; 3],
    },
    /// A view was made with another depth convention than the renderer.
    #[error("view {index}: its depth is {view:?}, this was made for {made_for:?}")]
    Depth {
        /// Place in the frame's views.
        index: usize,
        /// The convention of the descriptor.
        made_for: crate::DepthConvention,
        /// The view's convention.
        view: crate::DepthConvention,
    },
    /// A caster is out of range.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// Geometry that only the host can draw, which cannot be projected here.
    #[error(
        "caster {index} is drawn by the host (CasterMesh::host_drawn), and planar shadows know only its bounds; leave it out here, or pass a mesh"
    )]
    HostDrawn {
        /// Place in the slice of casters.
        index: usize,
    },
    /// More casters, corners, or lights, planes and views than the device's buffers can hold.
    #[error("{what} need {size} bytes in one buffer, {limit} are possible; pass fewer of them")]
    TooMany {
        /// `"casters"`, `"corners"` or `"lights, planes and views"`.
        what: &'static str,
        /// Bytes needed.
        size: u64,
        /// Bytes possible.
        limit: u64,
    },
}

/// Why a [`PlanarShadow`](crate::PlanarShadow) draws nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum PlanarRenderError {
    /// `encode` has not been called since the last `prepare`, or neither has since `new` or `invalidate`.
    #[error("call prepare, then encode into the encoder of this pass, before render")]
    NotEncoded,
    /// The recorded work never reached the GPU.
    #[error(
        "the encoder that encode recorded into was dropped and not submitted; call prepare and encode again"
    )]
    Dropped,
    /// The last prepared frame has no such light, plane or view.
    #[error(
        "{what} {asked} was not prepared: the frame had {count}, counted from 0; pass indices into its lists"
    )]
    NoSuch {
        /// `"light"`, `"plane"` or `"view"`.
        what: &'static str,
        /// The place asked for.
        asked: usize,
        /// How many there are.
        count: usize,
    },
}

/// What can be wrong with a [`PlanarSoftShadow`](crate::PlanarSoftShadow) or a frame of it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PlanarSoftShadowError {
    /// The size of the texture is 0 or over the device's limit.
    #[error(
        "a texture of {size:?} texels is out of range; pass 1 to {limit} (max_texture_dimension_2d)"
    )]
    Size {
        /// Texels along width and height.
        size: [u32; 2],
        /// The largest that works.
        limit: u32,
    },
    /// The number of samples is 0, or more than 8 bits can count.
    #[error("samples = {samples} is out of range; pass 1 to {limit}")]
    Samples {
        /// The number passed.
        samples: u32,
        /// The largest that works.
        limit: u32,
    },
    /// The light is out of range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// The light's shape is invalid.
    #[error(
        "the shape {0:?} is invalid; pass finite numbers above 0, and vectors other than (0, 0, 0)"
    )]
    Shape(crate::LightShape),
    /// The rectangle has no area.
    #[error(
        "{0:?} is not a rectangle; pass finite vectors, and a width and a height that are not parallel"
    )]
    Rectangle(crate::PlanarRectangle),
    /// A caster is out of range.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// Geometry that only the host can draw, which cannot be projected here.
    #[error(
        "caster {index} is drawn by the host (CasterMesh::host_drawn), and planar shadows know only its bounds; leave it out here, or pass a mesh"
    )]
    HostDrawn {
        /// Place in the slice of casters.
        index: usize,
    },
    /// More casters or samples than the device's buffers can hold.
    #[error("{what} need {size} bytes in one buffer, {limit} are possible; pass fewer of them")]
    TooMany {
        /// `"casters"` or `"samples"`.
        what: &'static str,
        /// Bytes needed.
        size: u64,
        /// Bytes possible.
        limit: u64,
    },
}
