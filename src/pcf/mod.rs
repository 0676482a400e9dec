//! Percentage-closer filtering: how receivers read a shadow map.

mod kernel;
mod sampler;

pub use kernel::Kernel;
pub use sampler::{PcfDescriptor, PcfSampler};
