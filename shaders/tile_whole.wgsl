// A tile that is a whole layer of the texture; the six of a point light are layers in a row.

struct ShadowsTile {
    // From 0 to 1 across the texture.
    corner: vec2f,
    middle: vec2f,
    layer: i32,
}

fn shadows_tile(light: ShadowsLight) -> ShadowsTile {
    return ShadowsTile(vec2f(0.0), vec2f(0.5), i32(light.tiles.x >> 20u));
}

// Of the face that lies along x, along y or else along z, `forward` or against it.
fn shadows_tile_of(light: ShadowsLight, x: bool, y: bool, forward: bool) -> ShadowsTile {
    let pair = select(select(4, 2, y), 0, x);
    let layer = i32(light.tiles.x >> 20u) + pair + i32(!forward);
    return ShadowsTile(vec2f(0.0), vec2f(0.5), layer);
}

// A place on the tile, in texels from its middle, for samplers that blend: they end where the layer does.
fn shadows_tile_blend(light: ShadowsLight, tile: ShadowsTile, place: vec2f) -> vec2f {
    return place * light.step + 0.5;
}
