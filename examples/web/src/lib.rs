//! The page in the browser: one picture, with textbook shadows in its left half and this crate's in its right
//! half. Everything but [`web`] also runs outside a browser, where the page's pictures are checked.

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
