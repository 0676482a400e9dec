//! What a frame draws, and where in the buffers it lies.

pub(crate) mod cache;
pub(crate) mod count_bound;
pub(crate) mod draw_lists;
pub(crate) mod faces;
pub(crate) mod limits;
pub(crate) mod merged;
pub(crate) mod meshes;
pub(crate) mod pair;
pub(crate) mod params;
pub(crate) mod ranges;
pub(crate) mod scene;
pub(crate) mod seats;
pub(crate) mod volumes;
pub(crate) mod windows;
pub(crate) mod work;
