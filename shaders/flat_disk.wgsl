// The taps of a disk on a flat map: there is nothing beyond its one tile.
fn shadows_flat_lit(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    disk: ShadowsFlatDisk,
    offsets: texture_3d<f32>,
    column: vec2f,
    layer: f32,
    taps: u32,
    first: u32,
) -> f32 {
    return shadows_flat_lit_on(
        map, map_sampler, receiver, disk, offsets, column, layer, taps, first,
    );
}
