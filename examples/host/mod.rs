//! A small host: what the examples, the tests and the benches share. Not part of the library.
#![allow(dead_code, unused_imports)] // each of them uses its own part

pub mod exact;
pub mod gpu;
pub mod image;
pub mod interior;
pub mod peer_light;
pub mod peer_map;
pub mod peers;
pub mod pipelines;
pub mod ply;
pub mod random;
pub mod renderer;
pub mod scene;
pub mod scene_gpu;
pub mod shapes;
mod targets;
pub mod terminal;
pub mod timer;
