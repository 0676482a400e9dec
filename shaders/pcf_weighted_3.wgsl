// 3x3 texels, weighted, from 4 taps.

fn shadows_cube_weighted_3(
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
        2,
        vec4f(1.0, 1.0, 0.0, 0.0),
        vec4f(-1.0, 1.0, 0.0, 0.0),
        vec4f(2.0, 0.0, 0.0, 0.0),
        vec4f(-1.0, 1.0, 0.0, 0.0),
    );
}
