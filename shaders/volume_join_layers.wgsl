// The same pixel of another picture, in each view.

@group(0) @binding(0) var source: texture_2d_array<f32>;

@fragment
fn same(
    @builtin(position) position: vec4f,
    @builtin(view_index) layer: u32,
) -> @location(0) vec4f {
    return textureLoad(source, vec2i(position.xy), layer, 0);
}
