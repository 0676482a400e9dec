//! How lights become tiles: where each lies in the world, and which casters it holds.

mod cascades;
mod cube;
mod directional;
mod flat;
mod light_box;
mod near;
mod placement;
mod slices;
mod spot;
mod tiles;

pub(crate) use cascades::{Cascade, CascadesOf, fit_cascades};
pub(crate) use cube::ALL_FACES;
pub use cube::CubeFace;
pub(crate) use directional::{Fit, fit_directional};
pub(crate) use flat::{FlatFrame, axes};
pub(crate) use light_box::LightBox;
pub(crate) use near::NearPlane;
pub(crate) use placement::{MapShape, Placed};
pub(crate) use spot::fit_spot;
pub(crate) use tiles::{LightProjection, MOST_TILES, SlotLight, TileProjection, TileSides};
