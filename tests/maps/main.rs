//! Shadow maps as they are drawn: every texel, what is cached and what is left out, each against an exact answer.

mod atlas;
mod atlas_budget;
mod atlas_cascades;
mod atlas_casters;
mod atlas_debug;
#[path = "../common/mod.rs"]
mod common;
mod cube_cache;
mod cube_cross;
mod cube_formats;
mod cube_map;
mod cube_readers;
mod cube_still;
#[path = "../common/cubes.rs"]
mod cubes;
#[path = "../common/deformed.rs"]
mod deformed;
mod depth_planes;
mod flat_map;
mod host_mesh;
mod map_calls;
mod near_plane;
mod numerics;
mod places;
#[path = "../common/receivers.rs"]
mod receivers;
