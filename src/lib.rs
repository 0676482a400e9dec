//! Real-time shadows for any wgpu engine.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub use {glam, wgpu};

pub mod error;
pub mod light;
pub mod mesh;
#[cfg(feature = "reference")]
pub mod reference;
pub mod support;
pub mod view;
pub mod volume;
pub mod wgsl;

pub use light::{HomogeneousLight, PointLight};
pub use mesh::{Caster, CasterMesh, HostPositions};
pub use support::{Fallback, Support};
pub use view::{DepthConvention, View};
pub use volume::{
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, VolumeStatistics,
};
