//! What is decided for a caster before its volume is found and drawn. All in f64, and nothing here knows
//! any buffer.

pub(crate) mod decision;
pub(crate) mod facing;
pub(crate) mod far_end;
pub(crate) mod hull;
pub(crate) mod method;
pub(crate) mod near_light_cap;
pub(crate) mod near_plane;
pub(crate) mod reach;
pub(crate) mod scissor;
pub(crate) mod sight;
pub(crate) mod start;
pub(crate) mod world_box;
