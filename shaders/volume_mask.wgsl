// Whether a point of the screen is in shadow, from a mask that shadow volumes were counted into:
// 1 lit, 0 in shadow, between them where only some of a pixel's samples are lit. `pixel` is the
// fragment's own `@builtin(position).xy`, `light` the layer.
fn shadows_mask(mask: texture_2d_array<f32>, pixel: vec2f, light: i32) -> f32 {
    return textureLoad(mask, vec2i(pixel), light, 0).r;
}
