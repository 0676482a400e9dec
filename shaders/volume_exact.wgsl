// Whether a point of the screen is in shadow, from the exact count of the volumes that it is in: 1
// lit, 0 in shadow. `pixel` is the fragment's own `@builtin(position).xy`.
fn shadows_exact_visibility(counts: texture_2d<f32>, pixel: vec2f) -> f32 {
    return select(0.0, 1.0, textureLoad(counts, vec2i(pixel), 0).r == 0.0);
}
