//! Meshes that cast shadows: adjacency on the CPU, buffers on the GPU.

mod adjacency;
mod area;
mod blocks;
mod bounds;
mod caster;
mod data;
mod edges;
mod input;
mod parts;
mod planes;
mod raw;
mod records;
mod solid;
mod tolerance;
mod topology;
mod triangles;
mod weld;

pub use adjacency::{Adjacency, Edge, EdgeUse, MeshKind};
pub(crate) use blocks::{BLOCK, BlockWords};
pub use bounds::Bounds;
pub use caster::{Caster, CasterMesh, HostPositions};
pub(crate) use data::MeshData;
pub(crate) use planes::{Facings, LANES};
pub(crate) use records::EdgeRecord;
#[cfg(test)]
pub(crate) use records::edge_records;
pub use topology::Topology;
