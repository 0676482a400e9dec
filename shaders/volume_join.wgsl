// The same pixel of another picture.

@group(0) @binding(0) var source: texture_2d<f32>;

@fragment
fn same(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureLoad(source, vec2i(position.xy), 0);
}
