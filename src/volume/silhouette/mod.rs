//! From a light to a volume's faces.

mod compute;
mod cpu;
mod light_side;
mod ways;

pub(crate) use compute::{Extraction, LIGHT_SIDE};
#[cfg(test)]
pub(crate) use compute::{edges_source, facing_source, merge_source};
pub(crate) use cpu::{Counts, CpuVolume};
pub use ways::Silhouettes;
pub(crate) use ways::{Way, Ways};
