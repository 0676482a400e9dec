// The stored depth nearest to a direction, from the light's cube in an array.
fn shadows_cube_fetch(
    map: texture_cube_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    direction: vec3f,
) -> f32 {
    return textureSampleLevel(map, map_sampler, direction, receiver.cube, 0.0).x;
}
