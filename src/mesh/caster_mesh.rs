//! The GPU side of a mesh that casts shadows.

mod of_host;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use glam::{DMat3, Vec3};

use super::data::{MeshData, edge_records};
use super::host::{HostPositions, InstanceLayout, POSITION_SIZE};
use super::records::VertexRecords;
use super::solid::is_solid;
use super::upload::{check_size, storage_usage, upload};
use super::{Adjacency, Bounds, MeshKind};
use crate::error::CasterMeshError;

/// A mesh that casts shadows, on the GPU. Cheap to clone: clones share the buffers.
#[derive(Clone, Debug)]
pub struct CasterMesh(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    id: u64,
    revision: AtomicU64,
    device: wgpu::Device,
    positions: Positions,
    triangles: Triangles,
    kind: MeshKind,
    solid: bool,
    host_drawn: bool,
    places: Option<Places>,
    /// For shadow volumes; shadow maps read nothing of it.
    welded: Option<Welded>,
}

/// Where the positions are and what is known of them.
#[derive(Clone, Debug)]
struct Positions {
    buffer: wgpu::Buffer,
    stride: u64,
    offset: u64,
    count: u32,
    bounds: Bounds,
    radius: f32,
}

/// Three indices a triangle.
#[derive(Clone, Debug)]
struct Triangles {
    buffer: wgpu::Buffer,
    format: wgpu::IndexFormat,
    offset: u64,
    count: u32,
}

/// Where in the host's buffer the transforms are that it is drawn under.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    pub buffer: wgpu::Buffer,
    pub layout: InstanceLayout,
    pub stride: u64,
    pub offset: u64,
    pub count: u32,
}

/// What an adjacency says of a mesh.
#[derive(Debug)]
struct Welded {
    data: MeshData,
    /// Whether the positions were uploaded from main memory, so that they are known there.
    positions_known: bool,
    /// Made when a renderer first asks for them.
    records: OnceLock<VertexRecords>,
}

impl CasterMesh {
    /// Uploads a mesh. `positions` are those the adjacency was built from.
    ///
    /// GPU memory: 12 bytes per vertex and 12 per triangle. Main memory, for shadow volumes: the same, plus
    /// 16 bytes per edge and 4 per use of an edge; once silhouettes are found on the CPU, about another 17
    /// bytes per triangle. A [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer) keeps the data of the
    /// meshes it draws in buffers of its own.
    ///
    /// # Errors
    /// [`CasterMeshError`] if the counts differ, a position is not finite or a buffer would be
    /// larger than the device's limits allow.
    pub fn new<P: Copy + Into<[f32; 3]>>(
        device: &wgpu::Device,
        positions: &[P],
        adjacency: &Adjacency,
    ) -> Result<Self, CasterMeshError> {
        if positions.len() as u64 != u64::from(adjacency.vertex_count()) {
            return Err(CasterMeshError::PositionCount {
                positions: positions.len(),
                vertices: adjacency.vertex_count(),
            });
        }
        let packed: Vec<[f32; 3]> = positions.iter().map(|&p| p.into()).collect();
        if let Some(bad) = packed.iter().find(|p| !Vec3::from(**p).is_finite()) {
            return Err(CasterMeshError::NotFinite {
                what: "position",
                value: *bad,
            });
        }
        let bounds = Bounds::of_points(packed.iter().map(|&p| p.into())).unwrap_or(Bounds {
            min: Vec3::ZERO,
            max: Vec3::ZERO,
        });
        let usage = wgpu::BufferUsages::VERTEX | storage_usage(device);
        let positions = Positions {
            buffer: upload(device, "positions", &packed, usage)?,
            stride: POSITION_SIZE,
            offset: 0,
            count: adjacency.vertex_count(),
            bounds,
            radius: bounds.radius_of(packed.iter().map(|&p| p.into())),
        };
        let solid = is_solid(&packed, adjacency);
        Self::welded(device, positions, adjacency, solid, Some(packed))
    }

    /// Shares the host's own position buffer, so that a mesh that the host deforms there casts the shadow of
    /// its current shape. Welded vertices are read from the first of them: the host must keep them at the
    /// same position.
    ///
    /// Main memory: 12 bytes per triangle, 16 per edge and 4 per use of an edge.
    ///
    /// # Errors
    /// [`CasterMeshError`] if stride, offset, size, usages or bounds are unsuitable.
    pub fn from_host_positions(
        device: &wgpu::Device,
        positions: &HostPositions<'_>,
        adjacency: &Adjacency,
    ) -> Result<Self, CasterMeshError> {
        positions.validate(device, adjacency)?;
        let bounds = positions.bounds;
        let positions = Positions {
            buffer: positions.buffer.clone(),
            stride: positions.stride,
            offset: positions.offset,
            count: adjacency.vertex_count(),
            bounds,
            radius: bounds.radius_of([bounds.min, bounds.max]),
        };
        // The host may turn it inside out.
        Self::welded(device, positions, adjacency, false, None)
    }

    /// `packed`: the positions in main memory, if they are known there.
    fn welded(
        device: &wgpu::Device,
        positions: Positions,
        adjacency: &Adjacency,
        solid: bool,
        packed: Option<Vec<[f32; 3]>>,
    ) -> Result<Self, CasterMeshError> {
        let triangles = Triangles {
            buffer: upload(
                device,
                "triangles",
                adjacency.triangles(),
                wgpu::BufferUsages::INDEX,
            )?,
            format: wgpu::IndexFormat::Uint32,
            offset: 0,
            count: adjacency.triangles().len() as u32,
        };
        let kind = adjacency.kind();
        let edges = edge_records(adjacency);
        check_size(device, "edges", size_of_val(&edges[..]) as u64)?;
        if kind == MeshKind::General {
            let uses = size_of_val(adjacency.edge_uses());
            check_size(device, "edge uses", uses as u64)?;
        }
        let positions_known = packed.is_some();
        let welded = Welded {
            data: MeshData::new(packed.unwrap_or_default(), edges, adjacency),
            positions_known,
            records: OnceLock::new(),
        };
        let welded = Some(welded);
        Ok(Self::new_inner(
            device, positions, triangles, kind, solid, welded,
        ))
    }

    fn new_inner(
        device: &wgpu::Device,
        positions: Positions,
        triangles: Triangles,
        kind: MeshKind,
        solid: bool,
        welded: Option<Welded>,
    ) -> Self {
        let inner = Self::inner(device, positions, triangles, kind, solid, welded);
        Self(Arc::new(inner))
    }

    fn inner(
        device: &wgpu::Device,
        positions: Positions,
        triangles: Triangles,
        kind: MeshKind,
        solid: bool,
        welded: Option<Welded>,
    ) -> Inner {
        static NEXT_ID: AtomicU64 = AtomicU64::new(0);
        Inner {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            revision: AtomicU64::new(0),
            device: device.clone(),
            positions,
            triangles,
            kind,
            solid,
            host_drawn: false,
            places: None,
            welded,
        }
    }

    /// Whether only the host can draw it.
    pub fn is_host_drawn(&self) -> bool {
        self.0.host_drawn
    }

    /// How its shadow volume is built.
    pub fn kind(&self) -> MeshKind {
        self.0.kind
    }

    /// Whether it is closed and known to be wound counter-clockwise seen from outside.
    pub(crate) fn is_solid(&self) -> bool {
        self.0.solid
    }

    /// Number of triangles that cast, in all instances together. Those that collapsed during welding do not.
    pub fn triangle_count(&self) -> u32 {
        let places = self.0.places.as_ref().map_or(1, |places| places.count);
        self.0.triangles.count.saturating_mul(places)
    }

    /// Where it is drawn, if the host's buffer says so.
    pub(crate) fn places(&self) -> Option<&Places> {
        self.0.places.as_ref()
    }

    /// Number of indices to draw once.
    pub(crate) fn index_count(&self) -> u32 {
        self.0.triangles.count * 3
    }

    /// Bounds in the mesh's own space.
    pub fn bounds(&self) -> Bounds {
        self.0.positions.bounds
    }

    /// Radius of a sphere around the centre of [`bounds`](Self::bounds) that encloses the mesh
    /// under a linear map.
    ///
    /// The largest stretch of the map is bounded by Gershgorin's circles on its Gram matrix: exact
    /// where the columns are orthogonal (any scale, rotation, mirror), never too small.
    pub(crate) fn radius_under(&self, linear: &DMat3) -> f64 {
        let gram = linear.transpose() * *linear;
        let row_sums = gram.x_axis.abs() + gram.y_axis.abs() + gram.z_axis.abs();
        f64::from(self.0.positions.radius) * row_sums.max_element().sqrt()
    }

    /// Number of vertices in the position buffer.
    pub fn vertex_count(&self) -> u32 {
        self.0.positions.count
    }

    /// Marks the positions as changed since shadows were last drawn. The host calls it after deforming a mesh
    /// in its own position buffer, before preparing the frame. Faces of shadow maps that this mesh touches
    /// are then redrawn, and its shadow volumes extracted again. All clones share one revision.
    pub fn bump_revision(&self) {
        self.0.revision.fetch_add(1, Ordering::Relaxed);
    }

    /// How often [`bump_revision`](Self::bump_revision) has been called.
    pub fn revision(&self) -> u64 {
        self.0.revision.load(Ordering::Relaxed)
    }

    /// A number that no other mesh of this process has or will have; clones share it.
    pub(crate) fn id(&self) -> u64 {
        self.0.id
    }

    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.0.device
    }

    pub(crate) fn positions(&self) -> &wgpu::Buffer {
        &self.0.positions.buffer
    }

    /// Stride and offset of the positions, in bytes.
    pub(crate) fn layout(&self) -> (u64, u64) {
        (self.0.positions.stride, self.0.positions.offset)
    }

    /// Three indices a triangle, to draw with.
    pub(crate) fn indices(&self) -> (wgpu::BufferSlice<'_>, wgpu::IndexFormat) {
        let Triangles {
            buffer,
            format,
            offset,
            ..
        } = &self.0.triangles;
        (buffer.slice(offset..), *format)
    }

    /// Whether shadow volumes know enough of it.
    pub(crate) fn has_adjacency(&self) -> bool {
        self.0.welded.is_some()
    }

    /// Three welded vertices a triangle, `u32`, to draw a mesh with an adjacency with.
    pub(crate) fn triangles(&self) -> &wgpu::Buffer {
        &self.0.triangles.buffer
    }

    pub(crate) fn edge_count(&self) -> u32 {
        self.welded_data().map_or(0, |data| data.edges.len() as u32)
    }

    pub(crate) fn edge_use_count(&self) -> u32 {
        self.welded_data()
            .map_or(0, |data| data.edge_uses.len() as u32)
    }

    /// What an adjacency says of it, and the positions unless they are the host's.
    pub(crate) fn welded_data(&self) -> Option<&MeshData> {
        Some(&self.0.welded.as_ref()?.data)
    }

    /// The mesh in main memory, unless its positions are the host's.
    pub(crate) fn data(&self) -> Option<&MeshData> {
        let welded = self.0.welded.as_ref()?;
        welded.positions_known.then_some(&welded.data)
    }

    /// Triangles and edges for vertex shaders without storage buffers, unless the positions are
    /// the host's.
    pub(crate) fn records(&self) -> Option<&VertexRecords> {
        let data = self.data()?;
        let welded = self.0.welded.as_ref()?;
        let make = || VertexRecords::new(&self.0.device, data, self.0.kind);
        Some(welded.records.get_or_init(make))
    }

    /// Bytes of the larger buffer of [`records`](Self::records).
    pub(crate) fn record_bytes(&self) -> u64 {
        self.data()
            .map_or(0, |data| VertexRecords::size(data, self.0.kind))
    }
}
