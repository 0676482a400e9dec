// Keeps the samples of a pixel that are in shadow, for the stencil to be marked there.

@group(0) @binding(0) var counts: texture_multisampled_2d<f32>;

@fragment
fn shadowed(@builtin(position) position: vec4f) -> @builtin(sample_mask) u32 {
    return ~shadows_exact_lit_samples(counts, position.xy);
}
