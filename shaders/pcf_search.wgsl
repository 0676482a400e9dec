// The search for what blocks, where the receiver's tile holds all taps: sums of the plane's depths and of the
// depths stored at the taps that are blocked, and how many these are.
fn shadows_cube_search_on(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    disk: ShadowsCubeDisk,
    offsets: texture_3d<f32>,
    layer: f32,
    taps: u32,
) -> vec3f {
    var found = vec3f(0.0);
    var at = 0.25 * layer;
    for (var i = 0u; i < taps; i++) {
        let pair = textureSampleLevel(offsets, map_sampler, vec3f(0.5, 0.5, at), 0.0);
        let offset = select(pair.xy, pair.zw, (i & 1u) == 1u);
        at += 0.5 * layer;
        let depths = shadows_cube_tap(map, map_sampler, receiver, disk, offset);
        found += vec3f(depths, 1.0) * select(0.0, 1.0, depths.x < depths.y);
    }
    return found;
}
