//! The cheap and the baked techniques against exact visibility, each with what it cannot do.

mod blob;
#[path = "../common/mod.rs"]
mod common;
