// One tap on the nearest texel (Williams, "Casting Curved Shadows on Curved Surfaces", 1978).

fn shadows_cube_hard(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,
    position: vec3f,
    normal: vec3f,
) -> f32 {
    let receiver = shadows_cube_receiver(light, position, normal);
    if receiver.known >= 0.0 {
        return receiver.known;
    }
    return shadows_cube_texel(map, map_sampler, receiver, light.size, floor(receiver.texel));
}
