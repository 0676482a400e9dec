// What the exact counts say of a pixel, for a mask: 1 lit, 0 in shadow.

@group(0) @binding(0) var counts: texture_2d<f32>;

@fragment
fn counted(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(shadows_exact_visibility(counts, position.xy));
}
