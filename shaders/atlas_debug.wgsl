// Tiles of an atlas as they lie in its layers, an instance each.

@group(0) @binding(0) var map: texture_2d_array<f32>;

struct Tile {
    // Two opposite corners in clip space: left and top, right and bottom.
    @location(0) corners: vec4f,
    // Left and top in the layer, size, all in texels; the layer.
    @location(1) texels: vec4f,
    // Colour of the outline; the near plane's distance over the range, 0 for parallel rays.
    @location(2) outline: vec4f,
}

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) within: vec2f,
    @location(1) @interpolate(flat) texels: vec4f,
    @location(2) @interpolate(flat) outline: vec4f,
}

// A strip of two triangles.
@vertex
fn vertex(@builtin(vertex_index) index: u32, tile: Tile) -> Corner {
    let within = vec2f(f32(index & 1u), f32(index >> 1u));
    let clip = mix(tile.corners.xy, tile.corners.zw, within);
    return Corner(vec4f(clip, 0.0, 1.0), within, tile.texels, tile.outline);
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
    let from_middle = abs(in.within - 0.5);
    if max(from_middle.x, from_middle.y) > 0.48 {
        return vec4f(in.outline.rgb, 1.0);
    }
    let texel = vec2i(in.texels.xy + floor(in.within * in.texels.z));
    let stored = textureLoad(map, texel, i32(in.texels.w), 0).x;
    if stored == 0.0 {
        return vec4f(0.0, 0.0, 0.25, 1.0);
    }
    let near_per_range = in.outline.a;
    let along = select(1.0 - stored, near_per_range / stored, near_per_range > 0.0);
    return vec4f(vec3f(1.0 - min(along, 1.0)), 1.0);
}
