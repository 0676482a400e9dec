// One tap on the nearest texel (Williams, "Casting Curved Shadows on Curved Surfaces", 1978).
fn shadows_flat_filter(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
) -> f32 {
    var texel = shadows_flat_floor(receiver, receiver.texel);
    var depth = shadows_flat_plane(receiver, texel);
    // A texel that does not see the receiver's plane (it lies beyond the plane's horizon) says nothing of the
    // receiver: the one that mirrors it there stands in. Gone round once, not a branch: see pcf_square.wgsl.
    let rounds = select(0, 1, receiver.spot & (depth <= receiver.horizon));
    for (var i = 0; i < rounds; i++) {
        texel = shadows_flat_floor(receiver, 2.0 * receiver.texel - texel - 0.5);
        depth = shadows_flat_plane(receiver, texel);
        depth = select(depth, receiver.own, depth <= receiver.horizon);
    }
    let stored = shadows_flat_depths(map, map_sampler, receiver, texel).y;
    return select(0.0, 1.0, clamp(depth, 0.0, receiver.bound) >= stored);
}
