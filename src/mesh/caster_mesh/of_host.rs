//! Meshes that are the host's: its own buffers, many places, or geometry that only it can draw.

use std::sync::Arc;

use super::{CasterMesh, Places, Positions, Triangles};
use crate::error::CasterMeshError;
use crate::mesh::host::{HostInstances, HostMesh, POSITION_SIZE, check_bounds};
use crate::mesh::{Bounds, MeshKind};

impl CasterMesh {
    /// Shares the host's own vertices and indices, for shadow maps alone: nothing is uploaded, welded or
    /// kept in main memory, and no adjacency is needed. A mesh that the host deforms there casts the
    /// shadow of its present form ([`bump_revision`](Self::bump_revision)).
    ///
    /// Shadow volumes need to know which triangles meet at an edge, and refuse such a mesh
    /// ([`NoAdjacency`](crate::error::ShadowVolumeError::NoAdjacency)). Nor is it known whether it is
    /// closed: [`kind`](Self::kind) says [`MeshKind::General`], and maps draw both sides of it.
    ///
    /// # Errors
    /// [`CasterMeshError`] if layouts, sizes, usages or bounds do not fit.
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

    /// Stands for geometry that only the host can draw into a map: alpha-tested, skinned by its own
    /// shader, tessellated, driven by the GPU. As a [`Caster`](crate::Caster) its bounds are culled, and
    /// it is cached, like any other's; where a tile that they touch is drawn, the host is asked to draw it
    /// ([`ShadowAtlas::encode_with`](crate::ShadowAtlas::encode_with), and the same of other maps). When it has changed,
    /// [`bump_revision`](Self::bump_revision) says so.
    ///
    /// `bounds`, in the mesh's own space, enclose all that it will ever draw; `triangles`, at least 1, is
    /// about how many that are, by which [`StaticLayers`](crate::StaticLayers) go.
    ///
    /// Shadow volumes refuse such casters ([`NoAdjacency`](crate::error::ShadowVolumeError::NoAdjacency)).
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

    /// A mesh at many places, which lie in a buffer of the host: one caster for a whole forest, in one draw
    /// a tile. It shares the mesh's buffers, but has a revision of its own: transforms that the host changes,
    /// and positions of the mesh, count from the frame that follows a
    /// [`bump_revision`](Self::bump_revision) of this one.
    ///
    /// The caster's own transform comes after each of them. Positions in between are in `f32`, from the
    /// caster's origin: place the caster near its instances, not all at the world's origin. Both sides are
    /// drawn, as some places may mirror it. For shadow maps and the atlas; shadow volumes refuse it
    /// ([`NoAdjacency`](crate::error::ShadowVolumeError::NoAdjacency)).
    ///
    /// # Errors
    /// [`CasterMeshError`] if layout, size, usages or bounds do not fit, or the mesh is such a one itself.
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
