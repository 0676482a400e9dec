//! What is drawn in a frame, and from which casters: tiles whose texels are out of date, in the order
//! in which it matters, over layers of what is static.

// Not used until the atlas is.
#[allow(dead_code)]
mod allocation;
mod content;
mod face_masks;
mod faces;
mod flat_place;
// Not used until the atlas is.
#[allow(dead_code)]
mod importance;
mod schedule;
// Not used until the atlas is.
#[allow(dead_code)]
mod sizing;
mod slot;
mod slots;
mod static_layer;
mod visibility;

pub(crate) use content::{Content, Signature, Texels};
pub(crate) use faces::{Rules, SlotPlan, casters_drawn, choose_faces, follow, tally};
pub(crate) use flat_place::FlatPlace;
pub(crate) use schedule::longest_wait;
pub(crate) use slot::Slot;
pub(crate) use slots::Slots;
pub(crate) use static_layer::DrawMode;
