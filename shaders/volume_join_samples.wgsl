// The same sample of another picture.

@group(0) @binding(0) var source: texture_multisampled_2d<f32>;

@fragment
fn same(
    @builtin(position) position: vec4f,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4f {
    return textureLoad(source, vec2i(position.xy), i32(sample));
}
