//! Bad input, and what a map decides on the CPU: by wgpu's own validation, without a driver.

mod atlas_culling;
mod atlas_matrices;
mod atlas_moves;
#[path = "../common/mod.rs"]
mod common;
mod cube_errors;
mod debug_pass;
mod flat_errors;
mod found_by_fuzzing;
mod map_settings;
mod pcf_errors;
