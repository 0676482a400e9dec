//! Soft shadows on planes: the light is sampled at many points, each of which casts a hard shadow, counted in
//! a texture.

mod descriptor;
mod frame;
mod gpu;
mod samples;
mod shadow;

pub use descriptor::PlanarSoftShadowDescriptor;
pub use frame::{LightShape, PlanarRectangle, PlanarSoftFrame};
pub use shadow::{PlanarSoftShadow, PlanarSoftStatistics};
