//! What `compare` measures, held to bounds: scenes, hard cases, other engines' maps, motion,
//! growth and other arithmetic.

mod against_reference;
mod arithmetic;
mod atlas_cases;
mod baked;
mod cascades;
#[path = "../../../../tests/common/mod.rs"]
mod common;
mod far_from_origin;
mod growth;
mod hard_cases;
mod leaves;
mod peers;
mod pictures;
#[path = "../../../../tests/common/receivers.rs"]
mod receivers;
mod temporal;
mod timer;
