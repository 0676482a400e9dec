// The search for what blocks on a flat map.
fn shadows_flat_search(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    disk: ShadowsFlatDisk,
    offsets: texture_3d<f32>,
    layer: f32,
    taps: u32,
) -> vec3f {
    return shadows_flat_search_on(
        map, map_sampler, receiver, disk, offsets, layer, taps,
    );
}
