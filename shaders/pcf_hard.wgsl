// One tap on the nearest texel (Williams, "Casting Curved Shadows on Curved Surfaces", 1978).
fn shadows_cube_filter(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
) -> f32 {
    return shadows_cube_texel(map, map_sampler, receiver, size, floor(receiver.texel));
}
