// The stored depth nearest to a direction, as the map's texture has it.
fn shadows_cube_fetch(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    direction: vec3f,
) -> f32 {
    return textureSampleLevel(map, map_sampler, direction, 0.0).x;
}
