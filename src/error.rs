//! Errors: one enum per operation. Every message says what to change.

use thiserror::Error;

/// What can be wrong with triangles given to [`Adjacency`](crate::mesh::Adjacency).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The index list is no list of whole triangles.
    #[error("{count} indices are no multiple of {per_triangle}; pass {per_triangle} per triangle")]
    IndexCount {
        /// Length of the list that was passed.
        count: usize,
        /// Indices per triangle that the call expects (3, or 6 with adjacency).
        per_triangle: usize,
    },
    /// An index points past the last vertex.
    #[error(
        "index {index} at place {place} is out of range; the mesh has {vertices} vertices, so the largest is {}",
        i64::from(*vertices) - 1
    )]
    IndexOutOfRange {
        /// Where in the index list.
        place: usize,
        /// The index found there.
        index: u32,
        /// Number of vertices.
        vertices: u32,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has the position {position:?}; every coordinate must be finite")]
    Position {
        /// The vertex.
        vertex: u32,
        /// Its position.
        position: [f32; 3],
    },
    /// More vertices or triangles than 32-bit indices can address.
    #[error("{count} {what} are too many; at most {limit} fit 32-bit indices, split the mesh")]
    TooLarge {
        /// `"vertices"` or `"triangles"`.
        what: &'static str,
        /// How many were passed.
        count: usize,
        /// The largest count that works.
        limit: usize,
    },
    /// The weld tolerance is negative, NaN or not below 1.
    #[error("weld tolerance {0} is out of range; it is a fraction of the mesh's size, 0 <= t < 1")]
    Tolerance(f32),
    /// The list given to `from_raw` names a neighbour that shares no edge with its triangle.
    #[error(
        "triangle {triangle}: the adjacent vertex {vertex} across its edge {edge} forms no triangle of this mesh with that edge"
    )]
    NotAdjacent {
        /// The triangle.
        triangle: u32,
        /// The edge, 0 to 2: from corner `edge` to corner `edge + 1`.
        edge: u32,
        /// The vertex named as opposite.
        vertex: u32,
    },
}

/// What can be wrong with a light.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LightError {
    /// A coordinate is NaN or infinite.
    #[error("light position {0:?} is not finite")]
    Position([f32; 3]),
    /// The range is NaN, infinite, zero or negative.
    #[error("light range {0} is out of range; pass a finite distance above 0")]
    Range(f32),
    /// The near distance is not between 0 and the range.
    #[error("light near {near} is out of range; pass 0 < near < range = {range}")]
    Near {
        /// The near distance passed.
        near: f32,
        /// The range passed.
        range: f32,
    },
    /// The homogeneous coordinate is neither 0 nor 1.
    #[error("light w = {0}; pass 1 for a point light, 0 for a directional light")]
    Homogeneous(f32),
    /// A directional light without a direction.
    #[error("a directional light needs a direction; (0, 0, 0) was passed")]
    Direction,
    /// The cone of a spot light is none.
    #[error("spot half_angle {0} is out of range; pass radians, 0 < half_angle < pi / 2")]
    HalfAngle(f32),
}

/// What can be wrong with the host's camera.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// An entry is NaN or infinite.
    #[error("clip_from_world holds an entry that is not finite: {0:?}")]
    NotFinite([f32; 16]),
    /// The matrix has no eye: its x, y and w rows are linearly dependent.
    #[error("clip_from_world is singular: its x, y and w rows do not fix an eye")]
    Singular,
    /// The matrix's z row is not that of the depth convention it is said to have.
    #[error(
        "clip_from_world does not map depth as {0:?} does; pass the convention it was built with"
    )]
    Depth(crate::DepthConvention),
}

/// What can be wrong when a [`CasterMesh`](crate::CasterMesh) is made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CasterMeshError {
    /// The host's position buffer has a stride or offset that is no multiple of four, or a stride
    /// below 12 bytes.
    #[error(
        "position stride {stride} and offset {offset} do not fit; both must be multiples of 4 bytes, stride at least 12"
    )]
    Layout {
        /// Bytes between positions.
        stride: u64,
        /// Bytes before the first position.
        offset: u64,
    },
    /// The host's position buffer is too short.
    #[error("the position buffer holds {size} bytes; {needed} are needed for {vertices} vertices")]
    BufferTooSmall {
        /// Its size in bytes.
        size: u64,
        /// Bytes needed.
        needed: u64,
        /// Number of vertices of the adjacency.
        vertices: u32,
    },
    /// The host's position buffer lacks a usage.
    #[error("the position buffer was created without {missing:?}; add it to its usages")]
    BufferUsage {
        /// What is missing.
        missing: wgpu::BufferUsages,
    },
    /// A buffer of this mesh is larger than the device allows.
    #[error(
        "the mesh needs a {what} buffer of {size} bytes, the device's {limit_name} is {limit}; split the mesh or ask for a higher limit"
    )]
    TooLarge {
        /// Which buffer.
        what: &'static str,
        /// Bytes needed.
        size: u64,
        /// The limit's name in [`wgpu::Limits`].
        limit_name: &'static str,
        /// Bytes allowed.
        limit: u64,
    },
    /// The positions and the adjacency do not belong together.
    #[error("{positions} positions were passed for an adjacency over {vertices} vertices")]
    PositionCount {
        /// Number of positions passed.
        positions: usize,
        /// Number of vertices of the adjacency.
        vertices: u32,
    },
    /// A position or a bound is NaN or infinite.
    #[error("{what} {value:?} is not finite")]
    NotFinite {
        /// What it is, e.g. `"bounds"`.
        what: &'static str,
        /// The value.
        value: [f32; 3],
    },
}

/// What can be wrong with a [`Caster`](crate::Caster).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CasterError {
    /// An entry of the transform is NaN or infinite.
    #[error("caster {index}: its transform holds an entry that is not finite")]
    NotFinite {
        /// Place in the slice of casters.
        index: usize,
    },
    /// The transform flattens the mesh, so that no light position in its space exists.
    #[error(
        "caster {index}: its transform is singular (a scale of 0); leave the caster out instead"
    )]
    Singular {
        /// Place in the slice of casters.
        index: usize,
    },
    /// The mesh's buffers belong to another device.
    #[error("caster {index}: its mesh was made on another device; make a CasterMesh on this one")]
    Device {
        /// Place in the slice of casters.
        index: usize,
    },
}

/// A field of [`Bias`](crate::Bias) that is out of range.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("bias {field} = {value}; pass a finite number of texels, at least 0")]
pub struct BiasError {
    /// The field.
    pub field: &'static str,
    /// Its value.
    pub value: f32,
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
    /// The bias is out of range.
    #[error(transparent)]
    Bias(#[from] BiasError),
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
    /// No light at all, or more than the texture's layers can hold.
    #[error("a map for {lights} lights is out of range; 1 to {limit} (six layers each)")]
    Slots {
        /// Lights asked for.
        lights: u32,
        /// The most that work.
        limit: u32,
    },
    /// The format is none that a map can have.
    #[error("{0:?} cannot be a shadow map; pass Depth32Float, Depth24Plus or Depth16Unorm")]
    Format(wgpu::TextureFormat),
    /// A budget of no face at all.
    #[error("max_faces_per_frame is 0, so nothing would ever be drawn; pass at least 1, or None")]
    Budget,
    /// A slope-scaled bias where the fragment shader writes the depth.
    #[error(
        "bias slope_scale has no effect on LinearDistance, whose depth the fragment shader writes; pass 0 or use MajorAxis"
    )]
    SlopeScale,
    /// More lights in a frame than the map was made for.
    #[error("{lights} lights were passed to a map for {slots}; make it with more `lights`")]
    TooManyLights {
        /// Lights passed.
        lights: usize,
        /// Lights the map was made for.
        slots: usize,
    },
    /// A pinned light that is not in the frame.
    #[error("light {pinned} is pinned, but the frame has {lights} lights, counted from 0")]
    Pinned {
        /// The place that was passed.
        pinned: usize,
        /// Lights in the frame.
        lights: usize,
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
    /// The strata of a random disk are too few, too many or odd in number.
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
    /// The sampler was made for another kind of map.
    #[error(
        "this sampler reads {made_for:?} maps and was given a {given:?} map; make one with PcfDescriptor::map = {given:?}"
    )]
    Map {
        /// What the sampler was made for.
        made_for: crate::MapKind,
        /// What it was given.
        given: crate::MapKind,
    },
    /// The map's texels hold something else than the sampler's shader expects.
    #[error("the map holds {map:?} depths, the sampler reads {sampler:?}; make both with the same")]
    Encoding {
        /// What the map holds.
        map: crate::DepthEncoding,
        /// What the sampler reads.
        sampler: crate::DepthEncoding,
    },
    /// A sampler for many lights and a map with one texture for each.
    #[error(
        "the sampler reads many lights from one cube array, the map has a cube for each; make the map with cube_array, or the sampler without many_lights"
    )]
    NoCubeArray,
}

/// What can be wrong with the input of [`reference`](crate::reference).
#[cfg(feature = "reference")]
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// The index list is no list of whole triangles.
    #[error("object {object}: {count} indices are no multiple of 3; pass 3 per triangle")]
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
        "object {object}: vertex {vertex} has no finite place in the world; check it and the transform"
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
    /// The light is not one.
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
    /// An interior of shadow map texels that cannot be.
    #[error(
        "an interior of {face_size} texels a face, kernel radius {kernel_radius}, does not exist; pass at least 1 texel, a finite radius of at least 0, and a point light"
    )]
    Interior {
        /// Texels along the edge of a cube face.
        face_size: u32,
        /// Radius of the filter in texels.
        kernel_radius: f32,
    },
}

/// What can be wrong when a [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer) is made or
/// prepared.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ShadowVolumeError {
    /// The depth-stencil format is none of the two that have what shadow volumes need.
    #[error(
        "{0:?} does not fit; shadow volumes need Depth24PlusStencil8 or Depth32FloatStencil8 (an 8-bit stencil beside the depth)"
    )]
    Format(wgpu::TextureFormat),
    /// The sample count is neither 1 nor 4.
    #[error("{0} samples do not fit; pass 1 or 4, which every device has")]
    SampleCount(u32),
    /// The device was created without a feature that the descriptor needs.
    #[error("{needed_by} needs {feature:?}; ask for it when the device is created (see Support)")]
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
    /// A colour format that no colour target can have.
    #[error("color_formats[{place}] is {format:?}, which is no colour format")]
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
    /// The light or its range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A caster.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// The volume of one caster does not fit the device's buffers.
    #[error(
        "caster {index}: its {what} need {size} bytes in one buffer, {limit} are possible; split the mesh or ask for higher buffer limits"
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
    /// The positions lie in a buffer of the host, where the CPU cannot read them.
    #[error(
        "caster {index}: its positions are in the host's buffer, and only Silhouettes::Compute reads them there; make the mesh with CasterMesh::new or a renderer that may use compute"
    )]
    HostPositions {
        /// Place in the slice of casters.
        index: usize,
    },
    /// More casters than the device's buffers can describe.
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
    /// The bias is out of range.
    #[error(transparent)]
    Bias(#[from] BiasError),
    /// The light is out of range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A caster is out of range.
    #[error(transparent)]
    Caster(#[from] CasterError),
    /// The distance up to which a view shows shadows is out of range.
    #[error("shadow distance {0} is out of range; pass a finite distance above 0")]
    Distance(f32),
    /// The bounds of the receivers are no box.
    #[error("receivers from {min:?} to {max:?} are no box; pass finite corners, min <= max")]
    Receivers {
        /// The smallest corner passed.
        min: [f32; 3],
        /// The largest corner passed.
        max: [f32; 3],
    },
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

/// What can be wrong with a [`ShadowMask`](crate::ShadowMask) or a
/// [`LightJoin`](crate::LightJoin).
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
    /// The depth-stencil format does not fit, or the device was created without it.
    #[error(
        "{0:?} does not fit; pass Depth24PlusStencil8, or Depth32FloatStencil8 on a device with the feature of that name"
    )]
    Format(wgpu::TextureFormat),
    /// The colour format cannot be drawn into and blended on this device.
    #[error("{0:?} does not blend on this device; pass a colour format that does")]
    ColorFormat(wgpu::TextureFormat),
    /// The sample count is neither 1 nor 4.
    #[error("{0} samples do not fit; pass 1 or 4, which every device has")]
    SampleCount(u32),
    /// The source has another number of samples than the target.
    #[error("the source has {found} samples, the target {needed}; draw both with the same number")]
    Source {
        /// Samples of the source.
        found: u32,
        /// Samples of the target.
        needed: u32,
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
