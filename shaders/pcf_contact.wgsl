// Contact hardening for a light with a size (Fernando, "Percentage-Closer Soft Shadows", 2005):
// the mean depth of what blocks gives the penumbra's width, the width gives the disk. Depths are
// read, never filtered.
fn shadows_cube_filter(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    kernel: ShadowsKernel,
    offsets: texture_3d<f32>,
    pixel: vec2f,
) -> f32 {
    let turn = shadows_cube_turn(pixel, kernel.frame_shift);
    // The light faces the receiver; along the rays its disk is stretched over the tangent plane,
    // four times at most.
    let stretch = clamp(-1.0 / dot(receiver.normal, receiver.ray), 1.0, 4.0);
    let widest = shadows_cube_radius(receiver, kernel);
    // The table's first taps are a whole disk of their own, at this scale.
    let spread = sqrt(f32(kernel.taps) / f32(kernel.first_taps));
    let search = shadows_cube_turned(shadows_cube_disk(receiver, spread * widest, stretch), turn);
    let found = shadows_cube_search(
        map, map_sampler, receiver, search, offsets, kernel.layer, kernel.first_taps,
    );
    let blocked = found.z;
    let searched = f32(kernel.first_taps);
    let agree = blocked == 0.0 || blocked == searched;
    let gap = shadows_cube_gap(receiver, found.x, found.y, blocked);
    // Below a texel the map has nothing to say.
    let radius = clamp(kernel.light_size * gap, min(receiver.width, widest), widest);
    let disk = shadows_cube_turned(shadows_cube_disk(receiver, radius, stretch), turn);
    // One tap rather than a branch: drivers that run both sides of a branch leave a loop.
    let lit = shadows_cube_lit(
        map, map_sampler, receiver, disk, offsets, vec2f(0.5), kernel.layer,
        select(kernel.taps, 1u, agree), 0u,
    );
    return select(lit, select(1.0, 0.0, blocked > 0.0), agree);
}
