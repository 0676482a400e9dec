// One depth for four texels of a cube map: the nearest to the light that the receiver's plane has at any of
// them, so that a plane never shadows itself.
//
// A plane n.x = q from the light has the depth near * (n.d) / q in a direction d of length 1 along the
// major axis. At the receiver that is near / (its distance along that axis); from one texel to the next it
// changes by 2 / size of near * n / q along that axis of the texels. Each of the four is less than a texel
// away along both, so the sum of both changes is enough. Texels beyond an edge of the cube lie along
// another pair of axes: within a texel of edges it is the two steepest of the axes that may be those.
//
// `normal` is of any length and either sign, and its end may be off by `doubt`.
fn shadows_cube_hardware(
    map: texture_depth_cube,
    map_sampler: sampler_comparison,
    light: ShadowsCubeLight,
    position: vec3f,
    normal: vec3f,
    doubt: f32,
) -> f32 {
    let from_light = position - light.position;
    let n = abs(normal);
    let a = abs(from_light);
    let major = max(a.x, max(a.y, a.z));
    let texel = light.texel;
    // The axes that are the major one within a texel, and of those the one that the plane is least steep
    // along is left out.
    let out = select(vec3f(3e38), n, a >= vec3f(major - texel * major));
    let steepness = n.x + n.y + n.z - min(out.x, min(out.y, out.z)) + 1.5 * doubt;
    // The plane's distance, less what rounding may move the receiver or turn the plane.
    let rounding = light.rounding * dot(n, abs(position)) + 1.74 * doubt * major;
    let facing = max(abs(dot(normal, from_light)) - rounding, 1e-37);
    // The bias along the normal is one more share of a texel.
    let slope = (texel + light.normal_offset) * ((steepness + 1e-30) / facing);
    let near = light.scale * light.half_size;
    let own = near / major;
    // No nearer than a thirty-second of the receiver's distance, as for all kernels.
    let reference = min(own + near * slope, 32.0 * own) + light.quantum;
    let share = shadows_cube_compare(map, map_sampler, light.cube, from_light, reference);
    // Exactly 0 or 1 where all texels agree, however a sampler rounds the sum of their weights.
    let lit = saturate(share * (1.0 + 0x1p-16) - 0x1p-17);
    let drawn = select(lit, select(0.0, 1.0, light.cube == -1), light.cube < 0);
    return select(0.0, drawn, dot(from_light, from_light) <= light.range_squared);
}
