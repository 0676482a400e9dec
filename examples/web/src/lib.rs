//! The page in the browser: one picture, its left half shadowed as others do it, its right half by this
//! crate. Everything but [`web`] runs outside of a browser, too, where the page's pictures are checked.

pub mod app;
mod atlas;
pub mod choice;
#[cfg(target_arch = "wasm32")]
mod compose;
pub mod digest;
pub mod job;
pub mod motion;
pub mod picture;
pub mod places;
#[cfg(target_arch = "wasm32")]
mod readback;
#[cfg(target_arch = "wasm32")]
mod reference;
pub mod shadow;
pub mod statistics;
#[cfg(target_arch = "wasm32")]
mod web;
pub mod world;
