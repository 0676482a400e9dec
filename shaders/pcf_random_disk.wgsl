// A random disk: jittered, stratified offsets from an n x n x d texture, two in each texel, picked
// by the pixel modulo n (Wolff, "OpenGL 4 Shading Language Cookbook", 2013, after Uralsky,
// "Efficient Soft-Edged Shadows Using Pixel Shader Branching", GPU Gems 2, 2005). The outermost ring
// comes first: where its first eight agree, the rest is taken to agree with them.

fn shadows_cube_random_pairs(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    disk: ShadowsCubeDisk,
    offsets: texture_3d<f32>,
    column: vec2i,
    first: u32,
    end: u32,
) -> f32 {
    var lit = 0.0;
    for (var i = first; i < end; i++) {
        let pair = textureLoad(offsets, vec3i(column, i32(i)), 0);
        let a = shadows_cube_tap(map, map_sampler, receiver, size, disk, pair.xy);
        let b = shadows_cube_tap(map, map_sampler, receiver, size, disk, pair.zw);
        lit += select(0.0, 1.0, a.x >= a.y) + select(0.0, 1.0, b.x >= b.y);
    }
    return lit;
}

fn shadows_cube_random_disk(
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
    let column = vec2i(vec2u(pixel) % textureDimensions(offsets).xy);
    var first = 0u;
    var lit = 0.0;
    if kernel.first_taps > 0u {
        first = kernel.first_taps / 2u;
        lit = shadows_cube_random_pairs(
            map, map_sampler, receiver, light.size, disk, offsets, column, 0u, first,
        );
        if lit == 0.0 || lit == f32(kernel.first_taps) {
            return lit / f32(kernel.first_taps);
        }
    }
    lit += shadows_cube_random_pairs(
        map, map_sampler, receiver, light.size, disk, offsets, column, first, kernel.taps / 2u,
    );
    return lit / f32(kernel.taps);
}
