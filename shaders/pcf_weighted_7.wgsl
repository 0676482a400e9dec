// 7x7 texels, weighted, from 16 taps.

fn shadows_cube_weighted_7(
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
    return shadows_cube_weighted(
        map,
        map_sampler,
        receiver,
        light.size,
        4,
        vec4f(1.0, 12.0, 12.0, 1.0),
        vec4f(-1.0, -7.0, 4.0, 4.0),
        vec4f(5.0, 16.0, 5.0, 0.0),
        vec4f(-4.0, -4.0, 7.0, 1.0),
    );
}
