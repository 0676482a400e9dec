//! From a light to a volume's faces.

mod compute;

pub(super) use compute::{Extraction, workgroups};
#[cfg(test)]
pub(super) use compute::{edges_source, facing_source};
