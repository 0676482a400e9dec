//! From a light to a volume's faces.

mod compute;
mod cpu;
mod light_side;
mod ways;

pub(super) use compute::{Extraction, LIGHT_SIDE, workgroups};
#[cfg(test)]
pub(super) use compute::{edges_source, facing_source};
pub(super) use cpu::{Counts, CpuVolume};
pub use ways::Silhouettes;
pub(super) use ways::{Way, Ways};
