// One tap on the nearest texel (Williams, "Casting Curved Shadows on Curved Surfaces", 1978).
fn shadows_flat_filter(
    map: texture_2d<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    size: f32,
) -> f32 {
    return shadows_flat_texel(map, map_sampler, receiver, size, floor(receiver.texel));
}
