// The depths stored in the four texels around a corner: bottom left, bottom right, top right, top
// left.
fn shadows_flat_stored(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    corner: vec2f,
) -> vec4f {
    let at = corner * receiver.light.step + receiver.tile.middle;
    return textureGather(0, map, map_sampler, at, receiver.tile.layer);
}
