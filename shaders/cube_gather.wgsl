// The four stored depths around a direction. Bottom left, bottom right, top right, top left.
fn shadows_cube_gather(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    direction: vec3f,
) -> vec4f {
    return textureGather(0, map, map_sampler, direction);
}
