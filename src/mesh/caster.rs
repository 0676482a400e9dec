//! The GPU side of a mesh that casts shadows, and a caster: such a mesh somewhere in the world.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec3};
use wgpu::util::DeviceExt as _;

use super::data::{MeshData, edge_records};
use super::records::VertexRecords;
use super::solid::is_solid;
use super::{Adjacency, Bounds, MeshKind};
use crate::error::{CasterError, CasterMeshError};

/// Bytes of one position: three `f32`.
const POSITION_SIZE: u64 = 12;

/// A mesh that casts shadows, on the GPU. Cheap to clone: clones share the buffers.
#[derive(Clone, Debug)]
pub struct CasterMesh(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    id: u64,
    revision: AtomicU64,
    device: wgpu::Device,
    positions: wgpu::Buffer,
    stride: u64,
    offset: u64,
    vertex_count: u32,
    triangles: wgpu::Buffer,
    triangle_count: u32,
    edges: wgpu::Buffer,
    edge_count: u32,
    edge_uses: Option<wgpu::Buffer>,
    edge_use_count: u32,
    kind: MeshKind,
    solid: bool,
    bounds: Bounds,
    radius: f32,
    /// The same in main memory, if the positions were uploaded from there.
    data: Option<MeshData>,
    /// Made when a renderer first asks for them.
    records: OnceLock<VertexRecords>,
}

/// Positions that already lie in a vertex buffer of the host, read in place every frame.
#[derive(Clone, Debug)]
pub struct HostPositions<'a> {
    /// The buffer; its usages must include `VERTEX` and `STORAGE`.
    pub buffer: &'a wgpu::Buffer,
    /// Bytes from one position to the next: a multiple of 4, at least 12.
    pub stride: u64,
    /// Bytes before the first position: a multiple of 4.
    pub offset: u64,
    /// A box in the mesh's space that encloses every position the mesh will ever have.
    ///
    /// What leaves it may be culled.
    pub bounds: Bounds,
}

/// Where the positions are and what is known of them.
struct Source {
    buffer: wgpu::Buffer,
    stride: u64,
    offset: u64,
    bounds: Bounds,
    radius: f32,
    solid: bool,
    /// In main memory, if they are known there.
    packed: Option<Vec<[f32; 3]>>,
}

impl CasterMesh {
    /// Uploads a mesh. `positions` are those the adjacency was built from.
    ///
    /// GPU memory: 12 bytes a vertex, 12 a triangle, 16 an edge, and for
    /// [`MeshKind::General`] 4 for each use of an edge. Main memory: the same, and 4 bytes for each
    /// use of an edge in any case, for shadow volumes whose silhouettes are found on the CPU; where
    /// they are, another 17 bytes or so a triangle from the first time on.
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
        let source = Source {
            buffer: upload(device, "positions", &packed, usage)?,
            stride: POSITION_SIZE,
            offset: 0,
            bounds,
            radius: bounds.radius_of(packed.iter().map(|&p| p.into())),
            solid: is_solid(&packed, adjacency),
            packed: Some(packed),
        };
        Self::assemble(device, source, adjacency)
    }

    /// Shares the host's own position buffer, so that a mesh that the host deforms there casts the
    /// shadow of its present form. Vertices that were welded are read at the first of them: the
    /// host must keep them together.
    ///
    /// # Errors
    /// [`CasterMeshError`] if stride, offset, size, usages or bounds do not fit.
    pub fn from_host_positions(
        device: &wgpu::Device,
        positions: &HostPositions<'_>,
        adjacency: &Adjacency,
    ) -> Result<Self, CasterMeshError> {
        let HostPositions {
            buffer,
            stride,
            offset,
            bounds,
        } = *positions;
        if stride % 4 != 0 || offset % 4 != 0 || stride < POSITION_SIZE {
            return Err(CasterMeshError::Layout { stride, offset });
        }
        let vertices = adjacency.vertex_count();
        let span = u64::from(vertices.saturating_sub(1))
            .checked_mul(stride)
            .and_then(|span| span.checked_add(offset))
            .and_then(|span| span.checked_add(POSITION_SIZE));
        let needed = span.unwrap_or(u64::MAX);
        if vertices > 0 && buffer.size() < needed {
            return Err(CasterMeshError::BufferTooSmall {
                size: buffer.size(),
                needed,
                vertices,
            });
        }
        let usages = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE;
        let missing = usages - buffer.usage();
        if !missing.is_empty() {
            return Err(CasterMeshError::BufferUsage { missing });
        }
        check_size(device, "positions", buffer.size())?;
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
        let source = Source {
            buffer: buffer.clone(),
            stride,
            offset,
            bounds,
            radius: bounds.radius_of([bounds.min, bounds.max]),
            // The host may turn it inside out.
            solid: false,
            packed: None,
        };
        Self::assemble(device, source, adjacency)
    }

    fn assemble(
        device: &wgpu::Device,
        source: Source,
        adjacency: &Adjacency,
    ) -> Result<Self, CasterMeshError> {
        let storage = storage_usage(device);
        // Devices without storage buffers may want index buffers to be nothing else.
        let index = wgpu::BufferUsages::INDEX | (storage & wgpu::BufferUsages::STORAGE);
        let triangles = upload(device, "triangles", adjacency.triangles(), index)?;
        let kind = adjacency.kind();
        let uses = adjacency.edge_uses();
        let records = edge_records(adjacency);
        let edges = upload(device, "edges", &records, storage)?;
        let edge_uses = match kind {
            MeshKind::Closed => None,
            MeshKind::General => Some(upload(device, "edge uses", uses, storage)?),
        };
        static NEXT_ID: AtomicU64 = AtomicU64::new(0);
        let edge_count = records.len() as u32;
        let data = source
            .packed
            .map(|positions| MeshData::new(positions, records, adjacency));
        Ok(Self(Arc::new(Inner {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            revision: AtomicU64::new(0),
            device: device.clone(),
            positions: source.buffer,
            stride: source.stride,
            offset: source.offset,
            vertex_count: adjacency.vertex_count(),
            triangles,
            triangle_count: adjacency.triangles().len() as u32,
            edges,
            edge_count,
            edge_uses,
            edge_use_count: uses.len() as u32,
            kind,
            solid: source.solid,
            bounds: source.bounds,
            radius: source.radius,
            data,
            records: OnceLock::new(),
        })))
    }

    /// The rule its shadow volume follows.
    pub fn kind(&self) -> MeshKind {
        self.0.kind
    }

    /// Whether it is closed and known to be wound counter-clockwise seen from outside.
    pub(crate) fn is_solid(&self) -> bool {
        self.0.solid
    }

    /// Number of triangles that cast (those that collapsed in the weld do not).
    pub fn triangle_count(&self) -> u32 {
        self.0.triangle_count
    }

    /// Bounds in the mesh's own space.
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// Radius of a sphere around the centre of [`bounds`](Self::bounds) that encloses the mesh
    /// under a linear map.
    ///
    /// The largest stretch of the map is bounded by Gershgorin's circles on its Gram matrix: exact
    /// where the columns are orthogonal (any scale, rotation, mirror), never too small.
    pub(crate) fn radius_under(&self, linear: &DMat3) -> f64 {
        let gram = linear.transpose() * *linear;
        let row_sums = gram.x_axis.abs() + gram.y_axis.abs() + gram.z_axis.abs();
        f64::from(self.0.radius) * row_sums.max_element().sqrt()
    }

    /// Number of vertices in the position buffer.
    pub fn vertex_count(&self) -> u32 {
        self.0.vertex_count
    }

    /// Says that the positions have changed since shadows were last drawn: the host calls it after
    /// it deformed a mesh in its own position buffer, before it prepares the frame. Faces of shadow
    /// maps that this mesh touches are then drawn again, and its shadow volumes extracted again.
    /// All clones share one revision.
    pub fn bump_revision(&self) {
        self.0.revision.fetch_add(1, Ordering::Relaxed);
    }

    /// How often [`bump_revision`](Self::bump_revision) was called.
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
        &self.0.positions
    }

    /// Stride and offset of the positions, in bytes.
    pub(crate) fn layout(&self) -> (u64, u64) {
        (self.0.stride, self.0.offset)
    }

    /// Three welded vertices a triangle, `u32`: index buffer and storage buffer.
    pub(crate) fn triangles(&self) -> &wgpu::Buffer {
        &self.0.triangles
    }

    /// One record an edge; see [`edge_records`].
    pub(crate) fn edges(&self) -> &wgpu::Buffer {
        &self.0.edges
    }

    pub(crate) fn edge_count(&self) -> u32 {
        self.0.edge_count
    }

    /// One `u32` a use, `triangle << 1 | reversed`; only for general meshes.
    pub(crate) fn edge_uses(&self) -> Option<&wgpu::Buffer> {
        self.0.edge_uses.as_ref()
    }

    /// The mesh in main memory, unless its positions are the host's.
    pub(crate) fn data(&self) -> Option<&MeshData> {
        self.0.data.as_ref()
    }

    /// Triangles and edges for vertex shaders without storage buffers, unless the positions are
    /// the host's.
    pub(crate) fn records(&self) -> Option<&VertexRecords> {
        let data = self.data()?;
        let make = || VertexRecords::new(&self.0.device, data, self.0.kind);
        Some(self.0.records.get_or_init(make))
    }

    /// Bytes of the larger buffer of [`records`](Self::records).
    pub(crate) fn record_bytes(&self) -> u64 {
        self.data()
            .map_or(0, |data| VertexRecords::size(data, self.0.kind))
    }

    pub(crate) fn edge_use_count(&self) -> u32 {
        self.0.edge_use_count
    }
}

fn upload<T: bytemuck::NoUninit>(
    device: &wgpu::Device,
    what: &'static str,
    data: &[T],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, CasterMeshError> {
    check_size(device, what, size_of_val(data) as u64)?;
    // A binding may not be empty, so an empty mesh still gets one zeroed element.
    let empty = [0u8; 16];
    let contents = if data.is_empty() {
        &empty[..]
    } else {
        bytemuck::cast_slice(data)
    };
    Ok(
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(&format!("shadows caster {what}")),
            contents,
            usage,
        }),
    )
}

/// `STORAGE`, or where the device has no storage buffers a usage that every buffer may have.
fn storage_usage(device: &wgpu::Device) -> wgpu::BufferUsages {
    match device.limits().max_storage_buffers_per_shader_stage {
        0 => wgpu::BufferUsages::VERTEX,
        _ => wgpu::BufferUsages::STORAGE,
    }
}

fn check_size(device: &wgpu::Device, what: &'static str, size: u64) -> Result<(), CasterMeshError> {
    let limits = device.limits();
    let bound = match storage_usage(device) {
        wgpu::BufferUsages::STORAGE => limits.max_storage_buffer_binding_size,
        _ => u64::MAX,
    };
    for (limit_name, limit) in [
        ("max_buffer_size", limits.max_buffer_size),
        ("max_storage_buffer_binding_size", bound),
    ] {
        if size > limit {
            return Err(CasterMeshError::TooLarge {
                what,
                size,
                limit_name,
                limit,
            });
        }
    }
    Ok(())
}

/// A mesh somewhere in the world. Many casters may share one mesh.
#[derive(Clone, Debug)]
pub struct Caster {
    /// The mesh.
    pub mesh: CasterMesh,
    /// Any affine map from the mesh's space to world space: scale, shear and mirror included.
    pub world_from_object: Affine3A,
}

impl Caster {
    /// A mesh under a transform.
    pub fn new(mesh: CasterMesh, world_from_object: Affine3A) -> Self {
        Self {
            mesh,
            world_from_object,
        }
    }

    /// A mesh placed in f64, in a world whose coordinates are counted from `origin`.
    ///
    /// For scenes so far from their origin that f32 cannot place them: with `origin` at the camera
    /// (or anywhere near it), what is near the camera keeps all its digits. View and light must be
    /// placed from the same origin ([`View::placed`](crate::View::placed),
    /// [`HomogeneousLight::placed`](crate::HomogeneousLight::placed)), and the host draws the mesh
    /// with [`world_from_object`](Self::world_from_object) as it is here. An origin that stays where
    /// it is for a while, rather than following the camera, lets volumes be kept between frames.
    pub fn placed(mesh: CasterMesh, world_from_object: DAffine3, origin: DVec3) -> Self {
        let relative = DAffine3 {
            translation: world_from_object.translation - origin,
            ..world_from_object
        };
        Self::new(mesh, relative.as_affine3a())
    }

    /// The transform in f64 (bit for bit the same numbers).
    pub(crate) fn transform(&self) -> DAffine3 {
        let m = self.world_from_object;
        DAffine3::from_cols(
            m.matrix3.x_axis.as_dvec3(),
            m.matrix3.y_axis.as_dvec3(),
            m.matrix3.z_axis.as_dvec3(),
            m.translation.as_dvec3(),
        )
    }

    /// Checks what every pass needs of a caster.
    pub(crate) fn validate(&self, index: usize, device: &wgpu::Device) -> Result<(), CasterError> {
        if self.mesh.device() != device {
            return Err(CasterError::Device { index });
        }
        if !self.world_from_object.is_finite() {
            return Err(CasterError::NotFinite { index });
        }
        Ok(())
    }
}
