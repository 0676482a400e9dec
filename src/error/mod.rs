//! Errors: one enum per operation. Every message says what to change.

mod atlas;
mod blob;
mod cascades;
mod debug_pass;
mod light;
#[cfg(feature = "reference")]
mod light_map;
mod map;
mod mesh;
mod multiview;
mod names;
mod planar;
mod projected;
#[cfg(feature = "reference")]
mod reference;
mod tiles;
mod volume;
mod volume_debug;

pub use atlas::ShadowAtlasError;
pub use blob::{BlobRenderError, BlobShadowError};
pub use cascades::CascadeError;
pub use debug_pass::DebugPassError;
pub use light::{LightError, ViewError};
#[cfg(feature = "reference")]
pub use light_map::LightMapError;
pub use map::{BiasError, CubeShadowMapError, MapSettingsError, PcfError, ShadowMapError};
pub use mesh::{CasterError, CasterMeshError, MeshError};
pub use multiview::MultiviewError;
pub use planar::{PlanarRenderError, PlanarShadowError, PlanarSoftShadowError};
pub use projected::ProjectedShadowError;
#[cfg(feature = "reference")]
pub use reference::ReferenceError;
pub use tiles::TileSizeError;
pub use volume::{ScreenPassError, ShadowVolumeError, VolumeRenderError};
pub use volume_debug::VolumeDebugError;
