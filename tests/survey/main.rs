//! The cheap and the baked techniques against exact visibility, each with what it cannot do.

mod ask;
mod bake;
mod blob;
#[path = "../common/mod.rs"]
mod common;
mod planar;
mod planar_errors;
mod planar_host;
mod planar_soft;
mod projected;
#[path = "../common/receivers.rs"]
mod receivers;
