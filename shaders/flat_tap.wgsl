// One tap of a disk on a flat map.

// Depth of the receiver's plane and the depth stored, at the texel that `local` falls on; `local` is
// a point of the plane along the axes of the light's frame.
fn shadows_flat_look(
    map: texture_2d<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    size: f32,
    local: vec3f,
) -> vec2f {
    let spot = receiver.perspective > 0.5;
    // A point behind the spot is mirrored at the receiver, which is before it.
    let point = select(local, 2.0 * receiver.local - local, spot & (local.x <= 0.0));
    let uv = point.yz * receiver.scale / select(1.0, point.x, spot);
    let texel = floor((uv * 0.5 + 0.5) * size);
    let depths = shadows_flat_depths(map, map_sampler, receiver, size, texel);
    // A directional light's receivers may be behind the map's end (depth 0), and the gap to their
    // blockers is measured to where they are. An empty texel is behind them wherever that is.
    let end = select(-3e38, 0.0, spot);
    let stored = select(end, depths.y, depths.y > 0.0);
    // The point is on the plane, but the texel's centre may be beyond the plane's horizon.
    let plane = select(receiver.own, depths.x, depths.x > receiver.horizon);
    return vec2f(min(plane, receiver.bound), stored);
}

// How much farther from its light than its blocker a receiver is: for a spot as a fraction of the
// blocker's distance, for a directional light in world units. From sums of the plane's depths and
// of the depths stored at the taps that are blocked.
fn shadows_flat_gap(receiver: ShadowsFlatReceiver, plane: f32, stored: f32, blocked: f32) -> f32 {
    let distance = (stored - plane) / blocked * receiver.range;
    return select(distance, stored / plane - 1.0, receiver.perspective > 0.5);
}
