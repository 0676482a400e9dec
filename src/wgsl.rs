//! The shaders, as text.
//!
//! Everything a host may see is prefixed `shadows_` (functions) or `Shadows` (types), takes
//! textures and samplers as parameters, and works pasted into a host's own shader.

/// Vertex positions in the arithmetic that shadow volumes use, so that depths come out bit-equal:
/// `shadows_clip_position(clip_from_world, world_from_object, position)`. Give the vertex
/// output `@invariant @builtin(position)`.
pub const POSITION: &str = include_str!("../shaders/position.wgsl");

/// Reads a [`ShadowMask`](crate::ShadowMask): `shadows_mask(mask, pixel, light)`, 1 lit, 0 in shadow.
pub const MASK: &str = include_str!("../shaders/volume_mask.wgsl");

/// Any of this crate's WGSL as a module for naga_oil, which hosts name by `path`, e.g.
/// `shadows::pcf`:
///
/// ```
/// let module = shadows::wgsl::import_module("shadows::mask", shadows::wgsl::MASK);
/// assert!(module.starts_with("#define_import_path shadows::mask\n"));
/// ```
///
/// and then `#import shadows::mask::shadows_mask` in the host's shader. Two samplers for the same kind
/// of map share their functions' names when pasted, and are two modules when imported. The text is
/// no plain WGSL: naga itself refuses the first line.
pub fn import_module(path: &str, wgsl: &str) -> String {
    format!("#define_import_path {path}\n{wgsl}")
}

/// Depth of casters on the faces of a cube map.
pub(crate) const CUBE_CASTER: &str = include_str!("../shaders/cube_caster.wgsl");

/// A cube map unfolded as a cross.
pub(crate) const CUBE_CROSS: &str = include_str!("../shaders/cube_cross.wgsl");
