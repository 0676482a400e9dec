//! Debug views and surveys: tools, not for every frame.

pub(crate) mod colors;
pub(crate) mod exact_counts;
pub(crate) mod pipelines;
pub(crate) mod screen_area;
pub(crate) mod survey;
pub(crate) mod views;
