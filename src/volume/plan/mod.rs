//! What a frame draws, and where in the buffers it lies.

pub(crate) mod cache;
pub(crate) mod count_bound;
pub(crate) mod faces;
pub(crate) mod limits;
pub(crate) mod params;
pub(crate) mod ranges;
