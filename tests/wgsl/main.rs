//! The library's WGSL as text: valid in every configuration, and written as drivers need it.

#[path = "../common/mod.rs"]
mod common;
mod explicit_comparisons;
#[path = "../common/modules.rs"]
mod modules;
#[path = "../common/pcf.rs"]
mod pcf;
mod pcf_import;
mod pcf_wgsl;
#[path = "../common/projected.rs"]
mod projected;
mod projected_wgsl;
mod uniform_branches;
