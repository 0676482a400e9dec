//! Kernels as receivers ask them: their weights, their bias and their error, against exact visibility.

mod atlas;
mod atlas_cascades;
mod cascade_seams;
#[path = "../common/mod.rs"]
mod common;
mod cube_receivers;
#[path = "../common/cubes.rs"]
mod cubes;
#[path = "../common/exact_kernels.rs"]
mod exact_kernels;
#[path = "../common/ground.rs"]
mod ground;
#[path = "../common/pcf.rs"]
mod pcf;
mod pcf_gather;
mod pcf_gl;
mod pcf_grazing;
mod pcf_hardware;
mod pcf_kernels;
mod pcf_own_group;
mod pcf_quality;
mod pcf_seams;
#[path = "../common/receivers.rs"]
mod receivers;
#[path = "../common/yard.rs"]
mod yard;
