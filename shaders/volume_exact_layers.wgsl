// Whether a point of the screen is in shadow, from the exact counts of the volumes that it is in, of which
// each view has a layer: 1 lit, 0 in shadow. `pixel` is the fragment's own `@builtin(position).xy`,
// `layer` its own `@builtin(view_index)`.
fn shadows_exact_visibility_of(counts: texture_2d_array<f32>, pixel: vec2f, layer: u32) -> f32 {
    return select(0.0, 1.0, textureLoad(counts, vec2i(pixel), layer, 0).r == 0.0);
}
