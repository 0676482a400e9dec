// A Vogel disk (Vogel, "A better way to construct the sunflower head", 1979), turned from pixel to
// pixel. The offsets come from a table: no sine or cosine.
fn shadows_cube_filter(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    kernel: ShadowsKernel,
    offsets: texture_3d<f32>,
    pixel: vec2f,
) -> f32 {
    let upright = shadows_cube_disk(receiver, shadows_cube_radius(receiver, kernel), 1.0);
    let disk = shadows_cube_turned(upright, shadows_cube_turn(pixel, kernel.frame_shift));
    return shadows_cube_lit(
        map, map_sampler, receiver, disk, offsets, vec2f(0.5), kernel.layer, kernel.taps, 0u,
    );
}
