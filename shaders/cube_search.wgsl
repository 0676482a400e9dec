// The search for what blocks on a cube map, as cube_disk.wgsl goes through its taps.
fn shadows_cube_search(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    in_world: ShadowsCubeDisk,
    offsets: texture_3d<f32>,
    layer: f32,
    taps: u32,
) -> vec3f {
    let disk = shadows_cube_on_face(receiver, in_world);
    let holds = shadows_cube_holds(receiver, disk);
    var found = shadows_cube_search_on(
        map, map_sampler, receiver, disk, offsets, layer, select(0u, taps, holds),
    );
    let end = select(taps, 0u, holds);
    var at = 0.25 * layer;
    for (var i = 0u; i < end; i++) {
        let pair = textureSampleLevel(offsets, map_sampler, vec3f(0.5, 0.5, at), 0.0);
        let offset = select(pair.xy, pair.zw, (i & 1u) == 1u);
        at += 0.5 * layer;
        let depths = shadows_cube_tap_over(map, map_sampler, receiver, disk, offset);
        found += vec3f(depths, 1.0) * select(0.0, 1.0, depths.x < depths.y);
    }
    return found;
}
