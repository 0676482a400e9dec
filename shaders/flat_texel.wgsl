// One texel of a tile, by its place in texels from the tile's middle.

// The stored depth at a place.
fn shadows_flat_fetch(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    place: vec2f,
) -> f32 {
    let at = place * receiver.light.step + receiver.tile.middle;
    return textureSampleLevel(map, map_sampler, at, receiver.tile.layer, 0.0).x;
}

fn shadows_flat_plane(receiver: ShadowsFlatReceiver, texel: vec2f) -> f32 {
    return receiver.own + dot(receiver.slope, texel + 0.5 - receiver.texel);
}

// Depth of the receiver's plane at a texel (0 or less beyond the plane's horizon), and the depth
// stored there. Beyond the tile's edge nothing is.
fn shadows_flat_depths(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    texel: vec2f,
) -> vec2f {
    let stored = shadows_flat_fetch(map, map_sampler, receiver, texel + 0.5);
    let plane = shadows_flat_plane(receiver, texel);
    return vec2f(plane, select(0.0, stored, shadows_flat_inside(receiver.light, texel)));
}
