//! Meshes and transforms that are read from the host's own buffers.

use super::upload::check_size;
use super::{Adjacency, Bounds};
use crate::error::CasterMeshError;

/// Bytes of one position: three `f32`.
pub(super) const POSITION_SIZE: u64 = 12;

/// Positions in a vertex buffer of the host, read in place every frame.
#[derive(Clone, Debug)]
pub struct HostPositions<'a> {
    /// The buffer; its usages must include `VERTEX` and `STORAGE`.
    pub buffer: &'a wgpu::Buffer,
    /// Bytes from one position to the next: a multiple of 4, at least 12, and at most the device's
    /// `max_vertex_buffer_array_stride`.
    pub stride: u64,
    /// Bytes before the first position: a multiple of 4.
    pub offset: u64,
    /// A box in the mesh's space that encloses every position the mesh will ever have.
    ///
    /// Anything outside may be culled.
    pub bounds: Bounds,
}

/// Vertices and indices in buffers of the host, which is all that shadow maps need. They are read in place
/// every frame and never copied.
#[derive(Clone, Debug)]
pub struct HostMesh<'a> {
    /// The buffer of positions, three `f32` each, possibly with other data in between; its usages must
    /// include `VERTEX`.
    pub vertices: &'a wgpu::Buffer,
    /// Bytes from one position to the next: a multiple of 4, at least 12, and at most the device's
    /// `max_vertex_buffer_array_stride`.
    pub stride: u64,
    /// Bytes before the position of vertex 0: a multiple of 4. (For a mesh with a base vertex in a larger
    /// buffer, add that many strides.)
    pub offset: u64,
    /// The buffer of indices, three per triangle; its usages must include `INDEX`. All indices must be in
    /// range.
    pub indices: &'a wgpu::Buffer,
    /// The format of the indices.
    pub index_format: wgpu::IndexFormat,
    /// Bytes before the first index: a multiple of an index's size.
    pub index_offset: u64,
    /// Number of indices: a multiple of 3.
    pub index_count: u32,
    /// A box in the mesh's space that encloses every position the mesh will ever have.
    ///
    /// Anything outside may be culled.
    pub bounds: Bounds,
}

/// Transforms of the instances of one mesh, in a vertex buffer of the host. They are read in place every
/// frame and never copied.
#[derive(Clone, Debug)]
pub struct HostInstances<'a> {
    /// The buffer; its usages must include `VERTEX`.
    pub buffer: &'a wgpu::Buffer,
    /// The layout of each transform.
    pub layout: InstanceLayout,
    /// Bytes from one transform to the next: a multiple of 4, at least the size of a transform, and at most
    /// the device's `max_vertex_buffer_array_stride`.
    pub stride: u64,
    /// Bytes before the first transform: a multiple of 4.
    pub offset: u64,
    /// Number of transforms.
    pub count: u32,
    /// A box around all instances, before the caster's own transform is applied.
    ///
    /// Anything outside may be culled.
    pub bounds: Bounds,
}

/// The layout of a transform of [`HostInstances`]: an affine map from the mesh's space, in `f32`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum InstanceLayout {
    /// The four columns of a 4x4 matrix, 64 bytes, like `glam::Mat4`. The last row is not read.
    Columns4x4,
    /// The three rows of a 3x4 matrix, 48 bytes.
    Rows3x4,
}

impl InstanceLayout {
    fn size(self) -> u64 {
        match self {
            Self::Columns4x4 => 64,
            Self::Rows3x4 => 48,
        }
    }
}

impl HostInstances<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), CasterMeshError> {
        let Self {
            stride,
            offset,
            count,
            ..
        } = *self;
        let least = self.layout.size();
        if !stride.is_multiple_of(4) || !offset.is_multiple_of(4) || stride < least {
            return Err(CasterMeshError::InstanceLayout {
                stride,
                offset,
                least,
            });
        }
        let limit = u64::from(device.limits().max_vertex_buffer_array_stride);
        if stride > limit {
            return Err(CasterMeshError::Stride { stride, limit });
        }
        let size = self.buffer.size();
        let last = u64::from(count.saturating_sub(1)).saturating_mul(stride);
        let needed = last.saturating_add(offset).saturating_add(least);
        if count > 0 && size < needed {
            return Err(CasterMeshError::InstanceBufferTooSmall {
                size,
                needed,
                count,
            });
        }
        if !self.buffer.usage().contains(wgpu::BufferUsages::VERTEX) {
            return Err(CasterMeshError::InstanceBufferUsage);
        }
        check_bounds(&self.bounds)
    }
}

impl HostPositions<'_> {
    /// Whether buffer, layout and bounds fit the device and an adjacency.
    pub(super) fn validate(
        &self,
        device: &wgpu::Device,
        adjacency: &Adjacency,
    ) -> Result<(), CasterMeshError> {
        let (stride, offset, size) = (self.stride, self.offset, self.buffer.size());
        check_layout(device, stride, offset)?;
        let vertices = adjacency.vertex_count();
        let span = u64::from(vertices.saturating_sub(1))
            .checked_mul(stride)
            .and_then(|span| span.checked_add(offset))
            .and_then(|span| span.checked_add(POSITION_SIZE));
        let needed = span.unwrap_or(u64::MAX);
        if vertices > 0 && size < needed {
            return Err(CasterMeshError::BufferTooSmall {
                size,
                needed,
                vertices,
            });
        }
        check_positions(
            self.buffer,
            wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
        )?;
        check_size(device, "positions", size)?;
        check_bounds(&self.bounds)
    }
}

impl HostMesh<'_> {
    /// Whether buffers, layouts and bounds fit the device and each other.
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), CasterMeshError> {
        check_layout(device, self.stride, self.offset)?;
        let index_size = self.index_format.byte_size() as u64;
        let (offset, count) = (self.index_offset, self.index_count);
        if !offset.is_multiple_of(index_size) || !count.is_multiple_of(3) {
            return Err(CasterMeshError::IndexLayout {
                offset,
                count,
                index_size,
            });
        }
        let size = self.indices.size();
        let needed = offset.saturating_add(u64::from(count) * index_size);
        if size < needed {
            return Err(CasterMeshError::IndexBufferTooSmall {
                size,
                needed,
                count,
            });
        }
        if count > 0 && self.vertex_count() == 0 {
            return Err(CasterMeshError::BufferTooSmall {
                size: self.vertices.size(),
                needed: self.offset.saturating_add(POSITION_SIZE),
                vertices: 1,
            });
        }
        check_positions(self.vertices, wgpu::BufferUsages::VERTEX)?;
        if !self.indices.usage().contains(wgpu::BufferUsages::INDEX) {
            return Err(CasterMeshError::IndexBufferUsage);
        }
        check_bounds(&self.bounds)
    }

    /// As many positions as the buffer has room for.
    pub(super) fn vertex_count(&self) -> u32 {
        let room = self.vertices.size().checked_sub(self.offset);
        let after_first = room.and_then(|room| room.checked_sub(POSITION_SIZE));
        let count = after_first.map_or(0, |bytes| bytes / self.stride + 1);
        u32::try_from(count).unwrap_or(u32::MAX)
    }
}

fn check_layout(device: &wgpu::Device, stride: u64, offset: u64) -> Result<(), CasterMeshError> {
    if !stride.is_multiple_of(4) || !offset.is_multiple_of(4) || stride < POSITION_SIZE {
        return Err(CasterMeshError::Layout { stride, offset });
    }
    let limit = u64::from(device.limits().max_vertex_buffer_array_stride);
    match stride > limit {
        true => Err(CasterMeshError::Stride { stride, limit }),
        false => Ok(()),
    }
}

fn check_positions(
    buffer: &wgpu::Buffer,
    usages: wgpu::BufferUsages,
) -> Result<(), CasterMeshError> {
    let missing = usages - buffer.usage();
    match missing.is_empty() {
        true => Ok(()),
        false => Err(CasterMeshError::BufferUsage { missing }),
    }
}

pub(super) fn check_bounds(bounds: &Bounds) -> Result<(), CasterMeshError> {
    for corner in [bounds.min, bounds.max] {
        if !corner.is_finite() {
            return Err(CasterMeshError::NotFinite {
                what: "bounds",
                value: corner.to_array(),
            });
        }
    }
    // Inside out they would hold nothing, and what is in them would be culled at random.
    if !bounds.min.cmple(bounds.max).all() {
        let [min, max] = [bounds.min, bounds.max].map(|corner| corner.to_array());
        return Err(CasterMeshError::Bounds { min, max });
    }
    Ok(())
}
