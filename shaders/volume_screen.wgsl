// A triangle over the whole screen.

@vertex
fn screen(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(f32(vertex & 1u) * 4.0 - 1.0, f32(vertex >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn one() -> @location(0) vec4f {
    return vec4f(1.0);
}
