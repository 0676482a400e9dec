// What the exact counts say of a pixel in each view, for a mask: 1 lit, 0 in shadow.

@group(0) @binding(0) var counts: texture_2d_array<f32>;

@fragment
fn counted(
    @builtin(position) position: vec4f,
    @builtin(view_index) layer: u32,
) -> @location(0) vec4f {
    return vec4f(shadows_exact_visibility_of(counts, position.xy, layer));
}
