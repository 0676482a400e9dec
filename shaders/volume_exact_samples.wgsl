// Which samples of a pixel are in light, from the exact counts of the volumes that they are in: a
// bit for each, the lowest for sample 0. As `@builtin(sample_mask)` it lets a fragment that is
// shaded once light those samples alone. `pixel` is the fragment's own `@builtin(position).xy`.
fn shadows_exact_lit_samples(counts: texture_multisampled_2d<f32>, pixel: vec2f) -> u32 {
    var lit = 0u;
    for (var sample = 0u; sample < textureNumSamples(counts); sample += 1u) {
        let count = textureLoad(counts, vec2i(pixel), i32(sample)).r;
        lit |= select(0u, 1u << sample, count == 0.0);
    }
    return lit;
}
