//! Helpers for the host's light passes: masks, exact counts, and combining targets.

pub(crate) mod checks;
pub(crate) mod exact_count;
pub(crate) mod join;
pub(crate) mod mask;
pub(crate) mod read;
pub(crate) mod screen;
pub(crate) mod targets;
