//! A small host, shared by the examples, tests and benches. Not part of the library.

pub mod depth_bounds;
pub mod exact;
// The library's own unit tests use these two as well, and are in its package, which holds no other package.
#[path = "../../../tests/common/unit/gpu.rs"]
pub mod gpu;
pub mod image;
pub mod interior;
pub mod masked_casters;
pub mod one_light;
pub mod peer_light;
pub mod peer_map;
pub mod peers;
pub mod pipelines;
pub mod ply;
pub mod random;
pub mod renderer;
pub mod scene;
pub mod scene_gpu;
#[path = "../../../tests/common/unit/shapes.rs"]
pub mod shapes;
mod targets;
pub mod terminal;
pub mod timer;
mod uniforms;
pub mod unwrap;
pub mod warped;
