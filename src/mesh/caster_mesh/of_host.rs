//! Meshes owned by the host: its own buffers, instances, or geometry that only it can draw.

use std::sync::Arc;

use super::{CasterMesh, Places, Positions, Triangles};
use crate::error::CasterMeshError;
use crate::mesh::host::{HostInstances, HostMesh, POSITION_SIZE, check_bounds};
use crate::mesh::{Bounds, MeshKind};

impl CasterMesh {
    /// Shares the host's own vertices and indices, for shadow maps only: nothing is uploaded, welded or kept
    /// in main memory, and no adjacency is needed. A mesh that the host deforms there casts the shadow of its
    /// current shape ([`bump_revision`](Self::bump_revision)).
    ///
    /// Shadow volumes need to know which triangles meet at an edge, and reject such a mesh
    /// ([`NoAdjacency`](crate::error::ShadowVolumeError::NoAdjacency)). Nor is it known whether the mesh is
    /// closed: [`kind`](Self::kind) is [`MeshKind::General`], and maps draw both sides of it.
    ///
    /// # Errors
    /// [`CasterMeshError`] if layouts, sizes, usages or bounds are unsuitable.
    pub fn from_host(device: &wgpu::Device, mesh: &HostMesh<'_>) -> Result<Self, CasterMeshError> {
        mesh.validate(device)?;
        let bounds = mesh.bounds;
        let positions = Positions {
            buffer: mesh.vertices.clone(),
            stride: mesh.stride,
            offset: mesh.offset,
            count: mesh.vertex_count(),
            bounds,
            radius: bounds.radius_of([bounds.min, bounds.max]),
        };
        let triangles = Triangles {
            buffer: mesh.indices.clone(),
            format: mesh.index_format,
            offset: mesh.index_offset,
            count: mesh.index_count / 3,
        };
        let kind = MeshKind::General;
        Ok(Self::new_inner(
            device, positions, triangles, kind, false, None,
        ))
    }

    /// A placeholder for geometry that only the host can draw into a map: alpha-tested, skinned by its own shader,
    /// tessellated, or GPU-driven. As a [`Caster`](crate::Caster) it is culled by its bounds and cached like any other.
    /// When a tile that it touches is drawn, the host is asked to draw it
    /// ([`ShadowAtlas::encode_with`](crate::ShadowAtlas::encode_with), and its counterparts of other maps). When the
    /// geometry has changed, call [`bump_revision`](Self::bump_revision).
    ///
    /// `bounds`, in the mesh's own space, must enclose everything that will ever be drawn; `triangles`, at
    /// least 1, is the approximate number of triangles, which [`StaticLayers`](crate::StaticLayers) use for
    /// their decision.
    ///
    /// Shadow volumes reject such casters ([`NoAdjacency`](crate::error::ShadowVolumeError::NoAdjacency)).
    ///
    /// # Errors
    /// [`CasterMeshError`] if the bounds are not finite, or there is no triangle.
    pub fn host_drawn(
        device: &wgpu::Device,
        bounds: Bounds,
        triangles: u32,
    ) -> Result<Self, CasterMeshError> {
        check_bounds(&bounds)?;
        if triangles == 0 {
            return Err(CasterMeshError::NoTriangles);
        }
        let nothing = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("shadows: drawn by the host"),
                size: 0,
                usage,
                mapped_at_creation: false,
            })
        };
        let positions = Positions {
            buffer: nothing(wgpu::BufferUsages::VERTEX),
            stride: POSITION_SIZE,
            offset: 0,
            count: 0,
            bounds,
            radius: bounds.radius_of([bounds.min, bounds.max]),
        };
        let triangles = Triangles {
            buffer: nothing(wgpu::BufferUsages::INDEX),
            format: wgpu::IndexFormat::Uint32,
            offset: 0,
            count: triangles,
        };
        let kind = MeshKind::General;
        let mut inner = Self::inner(device, positions, triangles, kind, false, None);
        inner.host_drawn = true;
        Ok(Self(Arc::new(inner)))
    }

    /// Instances of a mesh, with transforms in a buffer of the host: one caster for a whole forest, in one
    /// draw per tile. It shares the mesh's buffers, but has its own revision: changes to the transforms, and
    /// to the positions of the mesh, take effect in the frame that follows a
    /// [`bump_revision`](Self::bump_revision) of this one.
    ///
    /// The caster's own transform is applied after that of each instance. Intermediate positions are in
    /// `f32`, relative to the caster's origin, so place the caster near its instances rather than at the
    /// world's origin. Both sides are drawn, as some instances may be mirrored. For shadow maps and the
    /// atlas; shadow volumes reject it ([`NoAdjacency`](crate::error::ShadowVolumeError::NoAdjacency)).
    ///
    /// # Errors
    /// [`CasterMeshError`] if layout, size, usages or bounds are unsuitable, or if the mesh is itself
    /// instanced.
    pub fn at_places(&self, instances: &HostInstances<'_>) -> Result<Self, CasterMeshError> {
        let mesh = &self.0;
        if mesh.places.is_some() || mesh.host_drawn {
            return Err(CasterMeshError::NotPlain);
        }
        instances.validate(&mesh.device)?;
        let bounds = instances.bounds;
        let positions = Positions {
            bounds,
            radius: bounds.radius_of([bounds.min, bounds.max]),
            ..mesh.positions.clone()
        };
        let (triangles, kind) = (mesh.triangles.clone(), MeshKind::General);
        let mut inner = Self::inner(&mesh.device, positions, triangles, kind, false, None);
        inner.places = Some(Places {
            buffer: instances.buffer.clone(),
            layout: instances.layout,
            stride: instances.stride,
            offset: instances.offset,
            count: instances.count,
        });
        Ok(Self(Arc::new(inner)))
    }
}
