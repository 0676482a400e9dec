//! WGSL source text for the host's own shaders.
//!
//! All public names are prefixed with `shadows_` (functions) or `Shadows` (types). Functions take textures
//! and samplers as parameters, and work when pasted into a host's own shader.

/// Computes vertex positions with the same arithmetic as shadow volumes, so that depths are bit-identical:
/// `shadows_clip_position(clip_from_world, world_from_object, position)`. Give the vertex output
/// `@invariant @builtin(position)`, in a struct that is not also the fragment stage's input: GLSL ES allows
/// that keyword on outputs only, but naga writes it in both places.
pub const POSITION: &str = include_str!("../shaders/position.wgsl");

/// Reads a [`ShadowMask`](crate::ShadowMask): `shadows_mask(mask, pixel, light)`, 1 lit, 0 in shadow. Of a mask
/// of several views, `light` is the layer: see
/// [`ShadowMaskDescriptor::multiview_mask`](crate::ShadowMaskDescriptor::multiview_mask).
pub const MASK: &str = include_str!("../shaders/volume_mask.wgsl");

/// Any of this crate's WGSL as a module for naga_oil, named by `path`, such as `shadows::pcf`:
///
/// ```
/// let module = shadows::wgsl::import_module("shadows::mask", shadows::wgsl::MASK);
/// assert!(module.starts_with("#define_import_path shadows::mask\n"));
/// ```
///
/// and then `#import shadows::mask::shadows_mask` in the host's shader. Two samplers for the same kind of map
/// have functions of the same names, which clash when pasted but not as separate modules. The text is not
/// plain WGSL: naga itself rejects the first line.
pub fn import_module(path: &str, wgsl: &str) -> String {
    format!("#define_import_path {path}\n{wgsl}")
}

/// Reads an [`ExactCount`](crate::ExactCount) with one sample per pixel:
/// `shadows_exact_visibility(counts, pixel)`, 1 lit, 0 in shadow.
pub const EXACT: &str = include_str!("../shaders/volume_exact.wgsl");

/// Reads an [`ExactCount`](crate::ExactCount) with several samples per pixel:
/// `shadows_exact_lit_samples(counts, pixel)`, one bit per sample, for use as a fragment shader's
/// `@builtin(sample_mask)`.
pub const EXACT_SAMPLES: &str = include_str!("../shaders/volume_exact_samples.wgsl");

/// Reads an [`ExactCount`](crate::ExactCount) of several views in a pass that draws them:
/// `shadows_exact_visibility_of(counts, pixel, layer)`, 1 lit, 0 in shadow; the layer is the fragment's
/// `@builtin(view_index)`.
pub const EXACT_LAYERS: &str = include_str!("../shaders/volume_exact_layers.wgsl");

/// Reads a [`PlanarSoftShadow`](crate::PlanarSoftShadow) through bindings of your own:
/// `shadows_planar_soft(counts, linear, rectangle, world)`, 1 lit, 0 in shadow.
/// [`PlanarSoftShadow::wgsl_module`](crate::PlanarSoftShadow::wgsl_module) returns it with the bindings
/// declared.
pub const PLANAR_SOFT: &str = include_str!("../shaders/planar_soft.wgsl");

/// Depth of casters on one face of a cube map, or on a flat map.
pub(crate) const CUBE_CASTER: &str = concat!(
    include_str!("../shaders/caster_places.wgsl"),
    include_str!("../shaders/cube_caster.wgsl"),
    include_str!("../shaders/cube_caster_face.wgsl"),
);

/// The same on wgpu's GL back end.
pub(crate) const CUBE_CASTER_GL: &str = concat!(
    include_str!("../shaders/caster_places.wgsl"),
    include_str!("../shaders/cube_caster.wgsl"),
    include_str!("../shaders/cube_caster_gl.wgsl"),
);

/// A cube map unfolded as a cross.
pub(crate) const CUBE_CROSS: &str = concat!(
    include_str!("../shaders/light_record.wgsl"),
    include_str!("../shaders/cube_cross.wgsl"),
);

/// Casters projected onto a plane, into the host's picture.
pub(crate) const PLANAR_CASTER: &str = concat!(
    include_str!("../shaders/caster_places.wgsl"),
    include_str!("../shaders/planar_caster.wgsl"),
    include_str!("../shaders/planar_shade.wgsl"),
);

/// The same, counted for each place of a light with a size.
pub(crate) const PLANAR_COUNT: &str = concat!(
    include_str!("../shaders/caster_places.wgsl"),
    include_str!("../shaders/planar_caster.wgsl"),
    include_str!("../shaders/planar_soft_count.wgsl"),
);

/// The outline of a plane.
pub(crate) const PLANAR_OUTLINE: &str = include_str!("../shaders/planar_outline.wgsl");
