// One comparison by the sampler: 2x2 texels, blended, all compared with one depth (Reeves, Salesin and
// Cook 1987, as hardware has it).
fn shadows_cube_hardware_bilinear(
    map: texture_depth_2d_array,
    map_sampler: sampler_comparison,
    light: ShadowsLight,
    position: vec3f,
    normal: vec3f,
) -> f32 {
    return shadows_cube_hardware(map, map_sampler, light, position, normal, 0.0);
}

// The same with the normal that two screen derivatives of the position span.
fn shadows_cube_hardware_derived(
    map: texture_depth_2d_array,
    map_sampler: sampler_comparison,
    light: ShadowsLight,
    position: vec3f,
    x: vec3f,
    y: vec3f,
) -> f32 {
    // How far rounding may move the end of their cross product: docs/numerics.md, "Ulps of positions".
    // Where that is all there is of it, all is lit but by what is very near the light: pass a normal.
    let a = abs(position);
    let off = 1.2e-7 * max(a.x, max(a.y, a.z));
    let doubt = 1.42 * off * (sqrt(dot(x, x) + dot(y, y)) + off);
    return shadows_cube_hardware(map, map_sampler, light, position, cross(x, y), doubt);
}
