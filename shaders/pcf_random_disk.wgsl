// A random disk: jittered, stratified offsets from an n x n x d texture, two in each texel, picked
// by the pixel modulo n (Wolff, "OpenGL 4 Shading Language Cookbook", 2013, after Uralsky,
// "Efficient Soft-Edged Shadows Using Pixel Shader Branching", GPU Gems 2, 2005). The outermost ring
// comes first.
fn shadows_cube_filter(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    kernel: ShadowsKernel,
    offsets: texture_3d<f32>,
    pixel: vec2f,
) -> f32 {
    let disk = shadows_cube_disk(receiver, shadows_cube_radius(receiver, kernel), 1.0);
    // Sampling repeats nothing: the pixel modulo n, at the texel's centre.
    let column = fract((floor(pixel) + 0.5) / vec2f(textureDimensions(offsets).xy));
    return shadows_cube_lit(
        map, map_sampler, receiver, disk, offsets, column, kernel.layer, kernel.taps,
        kernel.first_taps,
    );
}
