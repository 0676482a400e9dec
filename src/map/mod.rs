//! Shadow maps.

mod assign;
mod bias;
mod cross;
mod cube;
mod descriptor;
mod draws;
mod encode;
mod face;
mod flat;
mod flat_descriptor;
mod flat_frame;
mod joint;
mod light;
mod masks;
mod plan;
mod reach;
mod resources;
mod scene;
mod schedule;
mod slot;
mod statistics;
mod texture;
mod upload;
mod visible;

pub use bias::Bias;
pub use cross::{CubeCross, CubeCrossDescriptor};
pub use cube::CubeShadowMap;
pub use descriptor::{Allocation, CasterSides, CubeFrame, CubeShadowMapDescriptor, DepthEncoding};
pub use face::CubeFace;
pub use flat::{ShadowMap, texture_from_clip};
pub(crate) use flat_descriptor::FlatLightUniform;
pub use flat_descriptor::{FlatLight, ShadowFrame, ShadowMapDescriptor, ShadowMapStatistics};
pub use joint::FacePasses;
pub(crate) use light::LightUniform;
pub use statistics::{CubeStatistics, FaceState, FaceStatistics};
