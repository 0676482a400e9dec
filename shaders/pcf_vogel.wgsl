// A Vogel disk (Vogel, "A better way to construct the sunflower head", 1979), turned from pixel to
// pixel. The offsets come from a table: one rotation a tap, no sine or cosine.

fn shadows_cube_vogel(
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
    let disk = shadows_cube_disk(receiver, shadows_cube_radius(receiver, kernel), 1.0);
    let turn = shadows_cube_turn(pixel, kernel.frame_shift);
    var lit = 0.0;
    for (var i = 0u; i < kernel.taps; i++) {
        let offset = shadows_cube_turned(offsets, i, turn);
        let depths = shadows_cube_tap(map, map_sampler, receiver, light.size, disk, offset);
        lit += select(0.0, 1.0, depths.x >= depths.y);
    }
    return lit / f32(kernel.taps);
}
