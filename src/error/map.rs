//! Errors of shadow maps and of what reads them.

use thiserror::Error;

use super::CasterError;
use super::LightError;

/// A field of [`Bias`](crate::Bias) that is out of range.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("bias {field} = {value}; pass a finite number of texels, at least 0")]
#[non_exhaustive]
pub struct BiasError {
    /// The field.
    pub field: &'static str,
    /// Its value.
    pub value: f32,
}

/// What can be wrong with [`MapSettings`](crate::MapSettings).
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MapSettingsError {
    /// Maps do not support the format.
    #[error("{0:?} cannot be a shadow map; pass Depth32Float, Depth24Plus or Depth16Unorm")]
    Format(wgpu::TextureFormat),
    /// The bias is out of range.
    #[error(transparent)]
    Bias(#[from] BiasError),
    /// The reach of the kernels is out of range.
    #[error("the reach {0:?} is out of range; pass a number above 0, at most 64 texels")]
    Reach(crate::Radius),
}

/// What can be wrong with a [`CubeShadowMap`](crate::CubeShadowMap).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CubeShadowMapError {
    /// The size of a face is 0 or over the device's limit.
    #[error("a face of {size} texels is out of range; 1 to {limit} (max_texture_dimension_2d)")]
    Size {
        /// Texels along a face.
        size: u32,
        /// The largest that works.
        limit: u32,
    },
    /// The settings are out of range.
    #[error(transparent)]
    Settings(#[from] MapSettingsError),
    /// The light is out of range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A caster is out of range.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// More casters than one buffer of the device can hold.
    #[error("{instances} casters on faces need {size} bytes, max_buffer_size is {limit}")]
    TooManyCasters {
        /// Casters, each counted once for every face it touches.
        instances: usize,
        /// Bytes needed.
        size: u64,
        /// Bytes allowed.
        limit: u64,
    },
    /// A slope-scaled bias where the fragment shader writes the depth.
    #[error(
        "bias slope_scale has no effect on LinearDistance, whose depth the fragment shader writes; pass 0 or use MajorAxis"
    )]
    SlopeScale,
    /// Layers of static casters on a back end that cannot copy depth.
    #[error(
        "StaticLayers::AtLeast needs copies between depth textures, which wgpu's GL back end does not have; pass Auto or Never"
    )]
    StaticLayers,
    /// Layers of static casters without a cache.
    #[error(
        "StaticLayers::AtLeast has no effect on a map that is redrawn every frame (cache: false); pass StaticLayers::Auto or Never"
    )]
    NoStaticLayers,
    /// A cube view, on a back end that treats the layers of a texture either as an array or as a cube.
    #[error(
        "wgpu's GL back end reads a texture either as layers or as a cube; read the layers of CubeShadowMap::texture in the order of CubeFace::ALL"
    )]
    CubeView,
    /// A debug view for another encoding than the map's.
    #[error(
        "the map holds {map:?} depths, the view was made for {cross:?}; use the same encoding for both"
    )]
    Encoding {
        /// What the map holds.
        map: crate::DepthEncoding,
        /// What the view shows.
        cross: crate::DepthEncoding,
    },
}

/// What can be wrong with a [`ShadowMap`](crate::ShadowMap).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShadowMapError {
    /// The size of the map is 0 or over the device's limit.
    #[error("a map of {size} texels is out of range; 1 to {limit} (max_texture_dimension_2d)")]
    Size {
        /// Texels along a side.
        size: u32,
        /// The largest that works.
        limit: u32,
    },
    /// The settings are out of range.
    #[error(transparent)]
    Settings(#[from] MapSettingsError),
    /// The light is out of range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A caster is out of range.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// A directional light's map has not as many texels to spare as kernels reach.
    #[error(
        "kernels that reach {reach} texels need a larger map: that of a directional light is widened by that and one more texel on each side, by at most half, so pass a size of at least {}, not {size}, or a smaller reach",
        (4.0 * (reach + 1.0)).ceil()
    )]
    ReachOfSize {
        /// Texels that kernels reach.
        reach: f32,
        /// Texels along a side.
        size: u32,
    },
    /// The distance up to which a view shows shadows is out of range.
    #[error("shadow distance {0} is out of range; pass a finite distance above 0")]
    Distance(f32),
    /// The bounds of the receivers are not a valid box.
    #[error("receivers from {min:?} to {max:?} are not a box; pass finite corners, min <= max")]
    Receivers {
        /// The smallest corner passed.
        min: [f32; 3],
        /// The largest corner passed.
        max: [f32; 3],
    },
    /// The map lies so far from the origin, or is so large or so narrow, that its matrix is not
    /// finite in `f32`.
    #[error(
        "the map's matrix is not finite in f32: the light or a caster is too far away, or the cone too narrow; move the scene nearer to the origin, or widen the cone"
    )]
    BeyondF32,
    /// More casters than one buffer of the device can hold.
    #[error("{casters} casters need {size} bytes, max_buffer_size is {limit}")]
    TooManyCasters {
        /// Casters on the map.
        casters: usize,
        /// Bytes needed.
        size: u64,
        /// Bytes allowed.
        limit: u64,
    },
}

/// What can be wrong with a [`PcfSampler`](crate::PcfSampler).
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PcfError {
    /// The number of taps is out of range.
    #[error("{what} = {taps} is out of range; pass 4 to {limit}")]
    Taps {
        /// The field.
        what: &'static str,
        /// Its value.
        taps: u32,
        /// The largest value.
        limit: u32,
    },
    /// A random disk has too few strata, too many, or an odd number.
    #[error(
        "around x rings = {around} x {rings} taps are out of range; pass an even product, 8 to {limit}"
    )]
    Samples {
        /// Strata around the disk.
        around: u32,
        /// Rings.
        rings: u32,
        /// The most taps.
        limit: u32,
    },
    /// The radius of a disk is out of range.
    #[error("the radius {radius:?} is out of range; pass a number above 0, at most 64 texels")]
    Radius {
        /// The radius.
        radius: crate::Radius,
    },
    /// The side of the texture of offsets is out of range.
    #[error("a texture of {size} x {size} offsets is out of range; pass 1 to {limit}")]
    OffsetTexture {
        /// Texels along a side.
        size: u32,
        /// The most texels along a side.
        limit: u32,
    },
    /// The size of the light is out of range.
    #[error("light_size = {0} is out of range; pass a finite number above 0")]
    LightSize(f32),
    /// The sampler was made for another kind of map, or for another encoding.
    #[error(
        "this sampler reads maps of {made_for:?} and was given one of {given:?}; make one with PcfDescriptor::map = AnyMap::from(&map).kind()"
    )]
    Map {
        /// What the sampler was made for.
        made_for: crate::MapKind,
        /// What it was given.
        given: crate::MapKind,
    },
    /// Gathers on a device that has none.
    #[error(
        "the device has no texture gathers (it is a GL device without compute shaders, such as WebGL 2); pass Gather::Auto or Gather::Never"
    )]
    Gather,
    /// The kernel reaches farther than the map was created for.
    #[error(
        "the kernel reaches {kernel:?}, the map was made for {map:?}, and what is farther may be out of date or beside it; make the map with `reach: Radius::{kernel:?}` or more of that unit in its settings, or the sampler with a narrower kernel"
    )]
    Reach {
        /// The kernel's radius.
        kernel: crate::Radius,
        /// The map's reach.
        map: crate::Radius,
    },
    /// Receivers for no kind of light.
    #[error(
        "MapKind::Atlas has no kind of light, so that all would be dark; pass LightKinds::ALL or at least one"
    )]
    NoLightKinds,
    /// A prefix that does not form valid names.
    #[error(
        "the prefix of a module does not form valid WGSL names; pass letters, digits and underscores, not starting with a digit or with two underscores"
    )]
    Prefix,
    /// A hardware comparison of depths in which planes are not linear.
    #[error(
        "HardwareBilinear compares depths along the major axis and was made for {0:?}; pass map: MapKind::CUBE, or another kernel"
    )]
    HardwareEncoding(crate::MapKind),
    /// Textbook receivers of depths that they cannot read.
    #[error(
        "textbook receivers compare distances and were made for {0:?}; pass map: MapKind::Cube(DepthEncoding::LinearDistance), or textbook: false"
    )]
    Textbook(crate::MapKind),
    /// Textbook receivers with a kernel, which they do not have.
    #[error(
        "textbook receivers take one tap instead of {0:?}; leave kernel at its default, or pass textbook: false"
    )]
    TextbookKernel(crate::Kernel),
}
