//! The casters of a frame, and what of the world a view shows: nothing here knows any map.

mod blocks;
mod bounds;
mod caster_tree;
mod casters;
mod digest;
mod filter;
mod frustum;

pub(crate) use blocks::Block;
pub(crate) use bounds::{CasterBounds, HalfSpace};
pub(crate) use casters::{Casters, Change, Record, caster_digest};
pub(crate) use digest::Digest;
pub(crate) use filter::CasterFilter;
pub(crate) use frustum::{Frustum, Region};
