// The four stored depths around a corner of texels that is in this direction along the face's axes. Bottom
// left, bottom right, top right, top left.
fn shadows_cube_gather(
    map: texture_cube_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    direction: vec3f,
) -> vec4f {
    return textureGather(0, map, map_sampler, shadows_cube_to_world(receiver.face, direction), receiver.cube);
}
