//! What a host's light passes need: masks, exact counts, pictures joined.

pub(crate) mod checks;
pub(crate) mod exact_count;
pub(crate) mod join;
pub(crate) mod mask;
pub(crate) mod read;
pub(crate) mod screen;
pub(crate) mod targets;
