//! Real-time shadows for any wgpu engine.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub use {glam, wgpu};

pub mod error;
pub mod light;
pub mod map;
pub mod mesh;
pub mod pcf;
#[cfg(feature = "reference")]
pub mod reference;
pub mod support;
pub mod view;
pub mod volume;
pub mod wgsl;

pub use light::{HomogeneousLight, PointLight};
pub use map::{Bias, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, CubeStatistics};
pub use mesh::{Caster, CasterMesh, HostPositions};
pub use pcf::{Kernel, PcfDescriptor, PcfSampler};
pub use support::{Fallback, Support};
pub use view::{DepthConvention, View};
pub use volume::{
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, VolumeStatistics,
};
