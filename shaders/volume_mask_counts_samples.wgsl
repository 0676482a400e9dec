// What the exact counts say of a pixel, for a mask: the share of its samples that is lit.

@group(0) @binding(0) var counts: texture_multisampled_2d<f32>;

@fragment
fn counted(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let lit = countOneBits(shadows_exact_lit_samples(counts, position.xy));
    return vec4f(f32(lit) / f32(textureNumSamples(counts)));
}
