// One depth for four texels of a cube map: the nearest to the light that the receiver's plane has at any of
// them, so that a plane never shadows itself.
//
// A plane n.x = q from the light has the depth near * (n.d) / q in a direction d of length 1 along the
// major axis. At the receiver that is near / (its distance along that axis); from one texel to the next it
// changes by 2 / size of near * n / q along that axis of the texels. Each of the four is less than a texel
// away along both, so the sum of both changes is enough. All four are on the receiver's face: within half a
// texel of its edge the outermost texels count alone.
//
// `normal` is of any length and either sign, and its end may be off by `doubt`.
fn shadows_cube_hardware(
    map: texture_depth_2d_array,
    map_sampler: sampler_comparison,
    light: ShadowsLight,
    position: vec3f,
    normal: vec3f,
    doubt: f32,
) -> f32 {
    let from_light = position - light.position;
    let major = shadows_cube_major(from_light);
    let face = shadows_cube_face(from_light);
    let texel = light.texel;
    let across = abs(shadows_cube_across(face, normal));
    let steepness = across.x + across.y + 1.5 * doubt;
    // The plane's distance, less what rounding may move the receiver or turn the plane.
    let rounding = light.rounding * dot(abs(normal), abs(position)) + 1.74 * doubt * major;
    let facing = max(abs(dot(normal, from_light)) - rounding, 1e-37);
    // The bias along the normal is one more share of a texel.
    let slope = (texel + light.normal_offset) * ((steepness + 1e-30) / facing);
    let near = light.depth_per;
    let own = near / major;
    // No nearer than a thirty-second of the receiver's distance, as for all kernels.
    let reference = min(own + near * slope, 32.0 * own) + light.quantum;
    let tile = shadows_cube_tile(light, face);
    let place = shadows_cube_across(face, from_light) * (light.texels / major);
    let at = shadows_tile_blend(light, tile, place);
    let share = textureSampleCompareLevel(map, map_sampler, at, tile.layer, reference);
    // Exactly 0 or 1 where all texels agree, however a sampler rounds the sum of their weights.
    let lit = saturate(share * (1.0 + 0x1p-16) - 0x1p-17);
    let drawn = select(1.0, lit, shadows_casts(light));
    let reached = dot(from_light, from_light) <= light.range_squared;
    return select(0.0, drawn, reached & (shadows_kind(light) == 1u));
}
