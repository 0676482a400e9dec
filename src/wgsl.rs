//! The shaders that hosts may include.

/// `shadows_clip_position(clip_from_world, world_from_object, position) -> vec4f`.
///
/// A host that draws its casters through this function, into an `@invariant` position, gets the
/// same depth bits as the shadow passes.
pub const POSITION: &str = include_str!("../shaders/position.wgsl");
