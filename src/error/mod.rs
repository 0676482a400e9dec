//! Errors: one enum per operation. Every message says what to change.

mod light;
mod map;
mod mesh;
mod names;
#[cfg(feature = "reference")]
mod reference;
// Public with the atlas, which is the first to have sizes.
#[allow(dead_code)]
mod tiles;
mod volume;
mod volume_debug;

pub use light::{LightError, ViewError};
pub use map::{BiasError, CubeShadowMapError, PcfError, ShadowMapError};
pub use mesh::{CasterError, CasterMeshError, MeshError};
#[cfg(feature = "reference")]
pub use reference::ReferenceError;
pub(crate) use tiles::TileSizeError;
pub use volume::{ScreenPassError, ShadowVolumeError, VolumeRenderError};
pub use volume_debug::VolumeDebugError;
