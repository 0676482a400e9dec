// Keeps what is in shadow of a pixel, for the stencil to be marked there, in each view.

@group(0) @binding(0) var counts: texture_2d_array<f32>;

@fragment
fn shadowed(@builtin(position) position: vec4f, @builtin(view_index) layer: u32) {
    if shadows_exact_visibility_of(counts, position.xy, layer) > 0.0 {
        discard;
    }
}
