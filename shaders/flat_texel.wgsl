// One texel of a flat map.

fn shadows_flat_plane(receiver: ShadowsFlatReceiver, size: f32, texel: vec2f) -> f32 {
    return receiver.own + dot(receiver.slope, texel + 0.5 - receiver.texel);
}

// Depth of the receiver's plane at a texel (0 or less beyond the plane's horizon), and the depth
// stored there. Beyond the map's edge nothing is.
fn shadows_flat_depths(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    size: f32,
    texel: vec2f,
) -> vec2f {
    let place = (texel + 0.5) * receiver.step;
    let stored = textureSampleLevel(map, map_sampler, place, 0, 0.0).x;
    let plane = shadows_flat_plane(receiver, size, texel);
    return vec2f(plane, select(0.0, stored, shadows_flat_inside(size, texel)));
}
