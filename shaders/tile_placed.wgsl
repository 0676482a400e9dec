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

// By a face's number in the order of the tiles, which is `pair`, or one more if the face is `behind`.
fn shadows_tile_of(light: ShadowsLight, pair: i32, behind: bool) -> ShadowsTile {
    let x = select(light.tiles.x, light.tiles.y, behind);
    let y = select(light.tiles.z, light.tiles.w, behind);
    let z = select(light.last_tiles.x, light.last_tiles.y, behind);
    return shadows_tile_at(light, select(select(z, y, pair == 2), x, pair == 0));
}

// A place on the tile, in texels from its middle, for samplers that blend: no nearer to its edge than the
// centres of the outermost texels, so that no other tile is blended in.
fn shadows_tile_blend(light: ShadowsLight, tile: ShadowsTile, place: vec2f) -> vec2f {
    let most = light.middle - 0.5;
    return clamp(place, vec2f(-most), vec2f(most)) * light.step + tile.middle;
}
