//! Percentage-closer filtering: how receivers read a shadow map.

mod atlas_text;
mod bound;
mod disk;
mod gather;
mod kernel;
mod layout;
mod map_kind;
mod offsets;
mod sampler;
mod text;
mod weights;

pub use bound::ModulePlace;
pub use disk::{ContactHardening, Radius, RandomDisk, VogelDisk};
pub use gather::Gather;
pub use kernel::Kernel;
pub use map_kind::{AnyMap, FlatLights, LightKinds, MapKind};
pub use sampler::{PcfDescriptor, PcfSampler};
