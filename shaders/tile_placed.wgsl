// A tile that lies anywhere in the texture.

struct ShadowsTile {
    // From 0 to 1 across the texture.
    corner: vec2f,
    middle: vec2f,
    layer: i32,
}

fn shadows_tile_at(light: ShadowsLight, packed: u32) -> ShadowsTile {
    let units = vec2f(vec2u(packed, packed >> 10u) & vec2u(1023u));
    let corner = units * (16.0 * light.step);
    return ShadowsTile(corner, corner + light.middle * light.step, i32(packed >> 20u));
}

fn shadows_tile(light: ShadowsLight) -> ShadowsTile {
    return shadows_tile_at(light, light.tiles.x);
}

// Of the face that lies along x, along y or else along z, `forward` or against it. Each is selected by itself:
// a GPU has no vector instruction that selects one of two scalars.
fn shadows_tile_of(light: ShadowsLight, x: bool, y: bool, forward: bool) -> ShadowsTile {
    var packed = select(light.last_tiles.y, light.last_tiles.x, forward);
    packed = select(packed, light.tiles.w, y);
    packed = select(packed, light.tiles.z, y & forward);
    packed = select(packed, light.tiles.y, x);
    packed = select(packed, light.tiles.x, x & forward);
    return shadows_tile_at(light, packed);
}

// A place on the tile, in texels from its middle, for samplers that blend: no nearer to its edge than the
// centres of the outermost texels, so that no other tile is blended in.
fn shadows_tile_blend(light: ShadowsLight, tile: ShadowsTile, place: vec2f) -> vec2f {
    let most = light.middle - 0.5;
    return clamp(place, vec2f(-most), vec2f(most)) * light.step + tile.middle;
}
