// The four stored depths around a corner of texels that is in this direction. Bottom left, bottom right, top right, top left.
fn shadows_cube_gather(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    direction: vec3f,
) -> vec4f {
    return textureGather(0, map, map_sampler, direction);
}
