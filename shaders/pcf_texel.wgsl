// 1 where a texel sees the receiver's plane, 0 where a caster is nearer. A texel that does not see
// the plane at all (it lies beyond the plane's horizon) says nothing of the receiver; the one that
// mirrors it at the receiver stands in. Within half a texel of the horizon that may not see it either,
// and is compared with the receiver's own depth.
fn shadows_cube_texel(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    texel: vec2f,
) -> f32 {
    let mirrored = shadows_cube_floor(receiver, 2.0 * receiver.texel - texel - 0.5);
    let behind = shadows_cube_plane(receiver, texel) <= receiver.horizon;
    let at = select(texel, mirrored, behind);
    let depths = shadows_cube_depths(map, map_sampler, receiver, at);
    let plane = select(receiver.own, depths.x, depths.x > receiver.horizon);
    return select(0.0, 1.0, clamp(plane, 0.0, receiver.bound) >= depths.y);
}
