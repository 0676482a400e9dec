// One tap on the nearest texel (Williams, "Casting Curved Shadows on Curved Surfaces", 1978).
fn shadows_cube_filter(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
) -> f32 {
    var direction = shadows_cube_centre(receiver, receiver.local);
    var depth = shadows_cube_depth_in(receiver, direction);
    // A texel that does not see the receiver's plane (it lies beyond the plane's horizon) says nothing of the
    // receiver: the one that mirrors it there stands in. Gone round once, not a branch: see pcf_square.wgsl.
    let rounds = select(1, 0, depth > receiver.horizon);
    for (var i = 0; i < rounds; i++) {
        let place = receiver.local * (receiver.half_size / shadows_cube_major(receiver.local));
        direction = shadows_cube_centre(receiver, 2.0 * place - direction);
        depth = shadows_cube_depth_in(receiver, direction);
        let own = shadows_cube_depth_in(receiver, place);
        depth = select(own, depth, depth > receiver.horizon);
    }
    let stored = shadows_cube_stored_in(map, map_sampler, receiver, size, direction);
    return select(0.0, 1.0, min(depth, receiver.bound) >= stored);
}

// The plane's depth in a direction, in texels.
fn shadows_cube_depth_in(receiver: ShadowsCubeReceiver, direction: vec3f) -> f32 {
    return receiver.horizon + receiver.per_length * dot(receiver.given, direction);
}
