//! Triangles and edges as vertex buffers, for vertex shaders that find silhouettes by themselves.

use wgpu::util::DeviceExt as _;

use super::data::MeshData;
use super::{EdgeUse, MeshKind};

/// An edge with two triangles that use it, each whole and in its own order of corners; see `Edge`
/// in `volume_vertex.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct EdgeRecord {
    pub first: [[f32; 3]; 3],
    pub second: [[f32; 3]; 3],
    pub code: u32,
}

/// The buffers, read once an instance.
#[derive(Debug)]
pub(crate) struct VertexRecords {
    /// [`EdgeRecord`]s.
    pub edges: wgpu::Buffer,
    pub edge_count: u32,
    /// Three positions a triangle.
    pub triangles: wgpu::Buffer,
}

impl VertexRecords {
    pub fn new(device: &wgpu::Device, data: &MeshData, kind: MeshKind) -> Self {
        let records = edge_records(data, kind);
        let corners: Vec<_> = data.triangles.iter().map(|t| data.corners(t)).collect();
        let upload = |label, contents| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage: wgpu::BufferUsages::VERTEX,
            })
        };
        Self {
            edges: upload(
                "shadows caster edge records",
                bytemuck::cast_slice(&records),
            ),
            // No more than there are uses, which fit 32 bits.
            edge_count: records.len() as u32,
            triangles: upload("shadows caster corners", bytemuck::cast_slice(&corners)),
        }
    }

    /// Bytes of the larger of the two.
    pub fn size(data: &MeshData, kind: MeshKind) -> u64 {
        let records = match kind {
            MeshKind::Closed => data.edges.len() as u64,
            MeshKind::General => data.edges.iter().map(|e| u64::from(e[3].div_ceil(2))).sum(),
        };
        let edges = records * size_of::<EdgeRecord>() as u64;
        edges.max(36 * data.triangles.len() as u64)
    }
}

/// An edge's uses in pairs: one record for a closed mesh's edge, more where more than two
/// triangles meet.
pub(crate) fn edge_records(data: &MeshData, kind: MeshKind) -> Vec<EdgeRecord> {
    let mut records = Vec::with_capacity(data.edges.len());
    for &[a, b, first, second] in &data.edges {
        match kind {
            MeshKind::Closed => {
                records.push(data.record([a, b], (first, false), Some((second, true))));
            }
            MeshKind::General => {
                let uses = &data.edge_uses[first as usize..][..second as usize];
                let of = |edge_use: &EdgeUse| (edge_use.triangle(), edge_use.reversed());
                for pair in uses.chunks(2) {
                    records.push(data.record([a, b], of(&pair[0]), pair.get(1).map(of)));
                }
            }
        }
    }
    records
}

impl MeshData {
    fn corners(&self, triangle: &[u32; 3]) -> [[f32; 3]; 3] {
        triangle.map(|vertex| self.positions[vertex as usize])
    }

    fn record(
        &self,
        ends: [u32; 2],
        (first, first_reversed): (u32, bool),
        second: Option<(u32, bool)>,
    ) -> EdgeRecord {
        let corners = self.triangles[first as usize];
        let at = |end: u32| u32::from(corners[1] == end) + 2 * u32::from(corners[2] == end);
        let (second, second_reversed) = match second {
            Some((triangle, reversed)) => {
                (self.corners(&self.triangles[triangle as usize]), reversed)
            }
            None => ([self.positions[corners[0] as usize]; 3], false),
        };
        EdgeRecord {
            first: self.corners(&corners),
            second,
            code: at(ends[0])
                | at(ends[1]) << 2
                | u32::from(first_reversed) << 4
                | u32::from(second_reversed) << 5,
        }
    }
}
