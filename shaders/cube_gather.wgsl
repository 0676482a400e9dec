// The four stored depths around a corner of texels of the receiver's face, in texels from the face's middle.
// Bottom left, bottom right, top right, top left.
fn shadows_cube_gather(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    corner: vec2f,
) -> vec4f {
    let at = corner * receiver.light.step + receiver.tile.middle;
    return textureGather(0, map, map_sampler, at, receiver.tile.layer);
}
