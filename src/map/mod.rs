//! Shadow maps.

mod bias;
mod cube;
mod cull;
mod face;
mod resources;

pub use bias::Bias;
pub(crate) use cube::LightUniform;
pub use cube::{CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, CubeStatistics};
pub use face::CubeFace;
