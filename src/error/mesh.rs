//! Errors of meshes and casters.

use thiserror::Error;

use super::names::names;

/// What can be wrong with triangles given to [`Adjacency`](crate::mesh::Adjacency).
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The number of indices is not a multiple of three.
    #[error(
        "{count} indices are not a multiple of {per_triangle}; pass {per_triangle} per triangle"
    )]
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
    /// The weld tolerance is negative, NaN, or not below 1.
    #[error("weld tolerance {0} is out of range; it is a fraction of the mesh's size, 0 <= t < 1")]
    Tolerance(f32),
    /// The list given to `from_raw` names a neighbour that shares no edge with its triangle.
    #[error(
        "triangle {triangle}: the adjacent vertex {vertex} across its edge {edge} does not form a triangle of this mesh with that edge"
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

/// What can be wrong when a [`CasterMesh`](crate::CasterMesh) is made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CasterMeshError {
    /// The host's position buffer has a stride or offset that is not a multiple of four, or a stride
    /// below 12 bytes.
    #[error(
        "position stride {stride} and offset {offset} are invalid; both must be multiples of 4 bytes, stride at least 12"
    )]
    Layout {
        /// Bytes between positions.
        stride: u64,
        /// Bytes before the first position.
        offset: u64,
    },
    /// The host's positions or transforms are farther apart than the device allows.
    #[error("stride {stride} is over the device's max_vertex_buffer_array_stride, {limit}")]
    Stride {
        /// Bytes between them.
        stride: u64,
        /// The most that work.
        limit: u64,
    },
    /// The host's indices do not form whole triangles, or are misaligned.
    #[error(
        "{count} indices of {index_size} bytes from byte {offset} are invalid; pass a multiple of 3, and an offset that is a multiple of their size"
    )]
    IndexLayout {
        /// Bytes before the first index.
        offset: u64,
        /// Number of indices.
        count: u32,
        /// Bytes of an index.
        index_size: u64,
    },
    /// The host's index buffer is too short.
    #[error("the index buffer holds {size} bytes; {needed} are needed for {count} indices")]
    IndexBufferTooSmall {
        /// Its size in bytes.
        size: u64,
        /// Bytes needed.
        needed: u64,
        /// Number of indices.
        count: u32,
    },
    /// The host's index buffer lacks a usage.
    #[error("the index buffer was created without INDEX; add it to its usages")]
    IndexBufferUsage,
    /// The host's transforms have a stride or offset that is not a multiple of four, or a stride below their
    /// size.
    #[error(
        "transform stride {stride} and offset {offset} are invalid; both must be multiples of 4 bytes, stride at least {least}"
    )]
    InstanceLayout {
        /// Bytes between transforms.
        stride: u64,
        /// Bytes before the first transform.
        offset: u64,
        /// Bytes of a transform.
        least: u64,
    },
    /// The host's buffer of transforms is too short.
    #[error("the buffer of transforms holds {size} bytes; {needed} are needed for {count}")]
    InstanceBufferTooSmall {
        /// Its size in bytes.
        size: u64,
        /// Bytes needed.
        needed: u64,
        /// Number of transforms.
        count: u32,
    },
    /// The host's buffer of transforms lacks a usage.
    #[error("the buffer of transforms was created without VERTEX; add it to its usages")]
    InstanceBufferUsage,
    /// Host-drawn geometry without triangles.
    #[error("what the host draws has no triangle; pass about how many it has, at least 1")]
    NoTriangles,
    /// Instances of a mesh that is itself instanced, or drawn by the host.
    #[error(
        "a mesh that is instanced or host-drawn cannot be instanced again; pass the mesh that this one was made from"
    )]
    NotPlain,
    /// The host's position buffer is too short.
    #[error("the position buffer holds {size} bytes; {needed} are needed for {vertices} vertices")]
    BufferTooSmall {
        /// Its size in bytes.
        size: u64,
        /// Bytes needed.
        needed: u64,
        /// Number of vertices.
        vertices: u32,
    },
    /// The host's position buffer lacks a usage.
    #[error("the position buffer was created without {}; add it to its usages", names(*missing))]
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
    /// The bounds of the host's positions are not a valid box.
    #[error("bounds from {min:?} to {max:?} are not a box; pass corners with min <= max")]
    Bounds {
        /// The smallest corner passed.
        min: [f32; 3],
        /// The largest corner passed.
        max: [f32; 3],
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
    /// The mesh's buffers belong to another device.
    #[error("caster {index}: its mesh was made on another device; make a CasterMesh on this one")]
    Device {
        /// Place in the slice of casters.
        index: usize,
    },
}
