// One tap on the nearest texel (Williams, "Casting Curved Shadows on Curved Surfaces", 1978).
fn shadows_cube_filter(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
) -> f32 {
    // The receiver's own texel never leaves its face.
    let place = receiver.texel + receiver.light.middle;
    let centre = floor(place) + 0.5;
    let depth = receiver.own + dot(receiver.slope, centre - place);
    let stored = shadows_cube_stored(map, map_sampler, receiver, centre);
    var lit = select(0.0, 1.0, min(depth, receiver.bound) >= stored);
    // A texel that does not see the receiver's plane (it lies beyond the plane's horizon) says nothing of the
    // receiver: the one that mirrors it there stands in, on whichever face it is. Gone round once,
    // not a branch: see pcf_square.wgsl.
    let rounds = select(0, 1, depth <= receiver.horizon);
    for (var i = 0; i < rounds; i++) {
        lit = shadows_cube_texel(map, map_sampler, receiver, centre - receiver.light.middle - 0.5);
    }
    return lit;
}
