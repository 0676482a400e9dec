// Fills one tile of a layer, on which the viewport lies: with the depth that means "no caster", or with the
// texels that another texture has at the same place. (WebGPU copies depth by whole layers only.)

@group(0) @binding(0) var source: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    // One triangle, twice as wide and as high as the viewport; reverse-Z: farther than all.
    return vec4f(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(source, vec2i(pixel.xy), 0).x;
}
