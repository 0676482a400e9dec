// Covers tiles of one layer, on any of its mip levels: with light, or with the means of four texels of the level
// before.

@group(0) @binding(0) var finer: texture_2d_array<f32>;

struct Covered {
    @builtin(position) pixel: vec4f,
    @location(0) @interpolate(flat) layer: i32,
}

// A tile's corner and side, where the layer's is 1 (powers of two and their multiples: exact), and the layer.
@vertex
fn vertex(@builtin(vertex_index) index: u32, @location(0) tile: vec4f) -> Covered {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    let place = 2.0 * (tile.xy + tile.z * corner) - 1.0;
    return Covered(vec4f(place.x, -place.y, 0.5, 1.0), i32(tile.w));
}

@fragment
fn clear(in: Covered) -> @location(0) vec4f {
    return vec4f(1.0);
}

@fragment
fn halve(in: Covered) -> @location(0) vec4f {
    let at = 2 * vec2i(in.pixel.xy);
    let upper = textureLoad(finer, at, in.layer, 0) + textureLoad(finer, at + vec2i(1, 0), in.layer, 0);
    let lower = textureLoad(finer, at + vec2i(0, 1), in.layer, 0) + textureLoad(finer, at + vec2i(1, 1), in.layer, 0);
    return 0.25 * (upper + lower);
}
