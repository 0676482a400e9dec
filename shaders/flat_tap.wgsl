// One tap of a disk on a flat map.

// Depth of the receiver's plane and the depth stored, at the texel that `local` falls on; `local` is
// a point of the plane along the axes of the light's frame.
fn shadows_flat_look(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    local: vec3f,
) -> vec2f {
    // For a point behind the spot the receiver stands in, which is before it.
    let behind = receiver.spot & (local.x <= 0.0);
    let light = receiver.light;
    let place = local.yz * (light.texels / select(1.0, local.x, receiver.spot));
    // In texels from the tile's corner.
    let centre = floor(select(place, receiver.texel, behind) + light.middle) + 0.5;
    let at = centre * light.step + receiver.tile.corner;
    let found = textureSampleLevel(map, map_sampler, at, receiver.tile.layer, 0.0).x;
    // A directional light's receivers may be behind the map's end (depth 0), and the gap to their
    // blockers is measured to where they are. An empty texel is behind them wherever that is.
    let nothing = select(-3e38, 0.0, receiver.spot);
    let stored = select(nothing, found, shadows_flat_inside(light, centre - 0.5 - light.middle) & (found > 0.0));
    let depth = receiver.corner + dot(receiver.slope, centre);
    // The point is on the plane, but the texel's centre may be beyond the plane's horizon.
    let beyond = receiver.spot & (depth <= receiver.horizon);
    let plane = select(depth, receiver.alone, beyond);
    return vec2f(min(plane, receiver.bound), stored);
}

// How much farther from its light than its blocker a receiver is: for a spot as a fraction of the
// blocker's distance, for a directional light in world units. From sums of the plane's depths and
// of the depths stored at the taps that are blocked.
fn shadows_flat_gap(receiver: ShadowsFlatReceiver, plane: f32, stored: f32, blocked: f32) -> f32 {
    let distance = (stored - plane) / (blocked * receiver.light.depth_per);
    return select(distance, stored / plane - 1.0, receiver.spot);
}
