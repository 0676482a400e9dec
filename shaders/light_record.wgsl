// What receivers know of a light of whatever kind: one record for a point or a spot light, one a cascade for a
// directional light.

struct ShadowsLight {
    // World space: of the light, or of a point on the near plane of a directional light's tile.
    position: vec3f,
    // Bits 0 and 1: 0 none (all is dark), 1 point, 2 spot, 3 directional. Bit 2: nothing casts, so all in range is
    // lit and there are no tiles. Bits 8 to 11: how many records of further cascades there are.
    kind: u32,
    // Axes of the tile in world space, of length 1. A point light has six tiles with axes of their own:
    // `forward` then is (`depth_per` over `texels`; the depth that bounds those of planes, for a receiver at
    // distance `texels` along the major axis; the range over the distance of the near plane).
    forward: vec3f,
    // Texels across 1 in the world (directional), at distance 1 (spot); a little less than `middle` (point), so
    // that scaled by it no direction is rounded to beyond a face.
    texels: f32,
    right: vec3f,
    // Half of the texels along a side of a tile: its middle, in texels from its corner.
    middle: f32,
    down: vec3f,
    // How far the light reaches, squared. Parallel rays reach everything.
    range_squared: f32,
    // Biases: in world units, at distance 1 of a spot or along the major axis of a point light; and as a factor
    // or, of a directional light, a difference of depth.
    normal_offset: f32,
    depth_bias: f32,
    // One step of the map's format.
    quantum: f32,
    // Coordinates of receivers are off by at most this part of themselves: docs/numerics.md, "Ulps of
    // positions".
    rounding: f32,
    // World width of a texel, at distance 1 of a spot or along the major axis of a point light.
    texel: f32,
    // How depth changes: by this over the distance (point and spot, the bias in it), by this times it
    // (directional).
    depth_per: f32,
    // Depth of 16 widths of the tile (directional).
    widths: f32,
    // One over the texels along a side of the texture.
    step: f32,
    // Where the tiles are: the corner nearest to that of the texture in units of 16 texels, x in bits 0 to 9, y
    // in bits 10 to 19, and the layer in bits 20 to 31. Six for a point light, in the order of the faces +X, -X,
    // +Y, -Y, then +Z, -Z; else one, and then the place of the first record of further cascades.
    tiles: vec4u,
    last_tiles: vec2u,
    // One over the texels before a cascade's border over which it blends into the next.
    per_blend: f32,
    // Where texel centres are between whole numbers, counted in texels from the middle of a tile: 0.5 if there
    // is an even number of texels along a side, else 0.
    centre: f32,
}

// The kind of light, and whether its tiles say what is lit.
fn shadows_kind(light: ShadowsLight) -> u32 {
    return light.kind & 3u;
}

fn shadows_casts(light: ShadowsLight) -> bool {
    return (light.kind & 4u) == 0u;
}
