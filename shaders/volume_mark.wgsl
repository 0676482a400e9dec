// Keeps what is in shadow of a pixel, for the stencil to be marked there.

@group(0) @binding(0) var counts: texture_2d<f32>;

@fragment
fn shadowed(@builtin(position) position: vec4f) {
    if shadows_exact_visibility(counts, position.xy) > 0.0 {
        discard;
    }
}
