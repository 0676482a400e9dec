//! What is drawn in a frame, and from which casters: tiles whose texels are out of date, in the order
//! in which it matters, over layers of what is static.

mod allocation;
mod choice;
mod content;
mod flat_place;
mod importance;
mod residents;
mod schedule;
mod sizing;
mod slot;
mod slots;
mod sorting;
mod static_layer;
mod tile_masks;
mod visibility;

pub(crate) use allocation::{Place, TileAllocator};
pub(crate) use choice::{Rules, SlotPlan, Tally, casters_drawn, choose_tiles, follow};
pub(crate) use flat_place::FlatPlace;
pub(crate) use importance::{LitSphere, Screen, importance};
pub(crate) use residents::{Claim, Residents};
pub(crate) use schedule::longest_wait;
pub use sizing::TileSize;
pub(crate) use slot::{Slot, Tile};
pub(crate) use slots::Slots;
#[cfg(test)]
pub(crate) use sorting::Reached;
pub(crate) use static_layer::DrawMode;
pub(crate) use tile_masks::tiles_of;
