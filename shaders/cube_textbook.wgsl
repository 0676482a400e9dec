// The method as textbooks have it: one tap, and a constant bias of 0.15 in world units. (A map of
// distances and a constant offset: Gerasimov, "Omnidirectional Shadow Mapping", GPU Gems, 2004.)
fn shadows_cube_textbook(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,
    position: vec3f,
    normal: vec3f,
) -> f32 {
    let from_light = position - light.position;
    var receiver: ShadowsCubeReceiver;
    receiver.light = light;
    let nearest = shadows_cube_fetch_in(map, map_sampler, receiver, from_light) * sqrt(light.range_squared);
    let distance = length(from_light);
    return select(1.0, 0.0, nearest + 0.15 < distance || distance * distance > light.range_squared);
}
