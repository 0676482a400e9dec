//! The cheap and the baked techniques against exact visibility, each with what it cannot do.

mod bake;
#[path = "../common/mod.rs"]
mod common;
mod projected;
#[path = "../common/receivers.rs"]
mod receivers;
