//! How lights become tiles: where each lies in the world, and which casters it holds.

mod cube;
mod directional;
mod flat;
mod near;
mod spot;
mod tiles;

pub(crate) use cube::ALL_FACES;
pub use cube::CubeFace;
pub(crate) use directional::{Fit, LightBox, fit_directional};
pub(crate) use flat::FlatFrame;
pub(crate) use near::NearPlane;
pub(crate) use spot::fit_spot;
pub(crate) use tiles::{LightProjection, MOST_TILES, TileProjection, TileSides};
