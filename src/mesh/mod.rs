//! Meshes that cast shadows: adjacency on the CPU, buffers on the GPU.

mod adjacency;
mod area;
mod blocks;
mod bounds;
mod caster;
mod caster_mesh;
mod data;
mod edges;
mod host;
mod input;
mod parts;
mod planes;
mod raw;
mod records;
mod solid;
mod tolerance;
mod topology;
mod triangles;
mod upload;
mod weld;

pub use adjacency::{Adjacency, Edge, EdgeUse, MeshKind};
pub(crate) use blocks::{BLOCK, BlockWords};
pub use bounds::Bounds;
pub use caster::Caster;
pub use caster_mesh::CasterMesh;
pub(crate) use data::{MeshData, edge_records as mesh_edges};
pub use host::{HostInstances, HostMesh, HostPositions, InstanceLayout};
pub(crate) use planes::{Facings, LANES};
pub(crate) use records::EdgeRecord;
#[cfg(test)]
pub(crate) use records::edge_records;
pub use topology::Topology;
