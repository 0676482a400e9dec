//! Meshes that cast shadows: adjacency on the CPU, buffers on the GPU.

mod adjacency;
mod bounds;
mod caster;

pub use adjacency::{Adjacency, Edge, EdgeUse, MeshKind, Topology};
pub use bounds::Bounds;
pub use caster::{Caster, CasterMesh, HostPositions};
