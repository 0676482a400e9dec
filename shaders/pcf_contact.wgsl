// Contact hardening for a light with a size (Fernando, "Percentage-Closer Soft Shadows", 2005):
// the mean depth of what blocks gives the penumbra's width, the width gives the disk. Depths are
// read, never filtered.

fn shadows_cube_contact(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,
    kernel: ShadowsCubeKernel,
    offsets: texture_3d<f32>,
    position: vec3f,
    normal: vec3f,
    pixel: vec2f,
) -> f32 {
    let receiver = shadows_cube_receiver(light, position, normal);
    if receiver.known >= 0.0 {
        return receiver.known;
    }
    let turn = shadows_cube_turn(pixel, kernel.frame_shift);
    // The light faces the receiver; along the rays its disk is stretched over the tangent plane,
    // four times at most.
    let stretch = clamp(-1.0 / dot(receiver.normal, receiver.ray), 1.0, 4.0);
    let widest = shadows_cube_radius(receiver, kernel);
    let search = shadows_cube_disk(receiver, widest, stretch);
    // The table's first taps are a whole disk of their own, at this scale.
    let spread = sqrt(f32(kernel.taps) / f32(kernel.first_taps));
    var plane = 0.0;
    var stored = 0.0;
    var blocked = 0.0;
    for (var i = 0u; i < kernel.first_taps; i++) {
        let offset = spread * shadows_cube_turned(offsets, i, turn);
        let depths = shadows_cube_tap(map, map_sampler, receiver, light.size, search, offset);
        if depths.x < depths.y {
            plane += depths.x;
            stored += depths.y;
            blocked += 1.0;
        }
    }
    if blocked == 0.0 {
        return 1.0;
    }
    if blocked == f32(kernel.first_taps) {
        return 0.0;
    }
    let gap = shadows_cube_gap(receiver, plane, stored, blocked);
    // Below a texel the map has nothing to say.
    let radius = clamp(kernel.light_size * gap, min(receiver.width, widest), widest);
    let disk = shadows_cube_disk(receiver, radius, stretch);
    var lit = 0.0;
    for (var i = 0u; i < kernel.taps; i++) {
        let offset = shadows_cube_turned(offsets, i, turn);
        let depths = shadows_cube_tap(map, map_sampler, receiver, light.size, disk, offset);
        lit += select(0.0, 1.0, depths.x >= depths.y);
    }
    return lit / f32(kernel.taps);
}
