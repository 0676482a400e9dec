// One depth for four texels of a flat map: the nearest to the light that the receiver's plane has at any of
// them, so that a plane never shadows itself.
//
// Depth is linear over the map, so that is at one of the corners of the square between the texels' centres:
// along each axis at the one that the plane rises toward.
//
// `normal` is of any length and either sign, and its end may be off by `doubt`.
fn shadows_flat_hardware(
    map: texture_depth_2d_array,
    map_sampler: sampler_comparison,
    light: ShadowsLight,
    position: vec3f,
    normal: vec3f,
    doubt: f32,
) -> f32 {
    let axes = mat3x3f(light.forward, light.right, light.down);
    let from_light = position - light.position;
    let local = from_light * axes;
    let n = normal * axes;
    let spot = shadows_flat_spot(light);
    let squared = dot(local, local);
    let away = select(1.0, local.x, spot);
    let facing = select(n.x, dot(n, local), spot);
    // How far rounding may move the receiver off its plane, and with it the plane of a spot.
    let rounding = light.rounding * dot(abs(normal), abs(position));
    let moved = select(doubt, rounding + doubt * sqrt(squared), spot);
    // How depth changes along the normal. Where there is no plane it is as steep as can be.
    let slope = light.depth_per / max(abs(facing) - moved, 1e-37);
    let steepness = select(-slope, slope, facing > 0.0) * n.yz;
    let gradient = light.texel * steepness;
    let inverse = 1.0 / away;
    let place = local.yz * (light.texels * inverse);
    let between = fract(place + light.centre);
    let rise = max(gradient, vec2f(0.0)) - gradient * between;
    let own = select(1.0 - local.x * light.depth_per + light.depth_bias, light.depth_per * inverse, spot);
    // No nearer than a thirty-second of the receiver's distance, or sixteen widths of the map before it.
    let bound = own + select(light.widths, 31.0 * own, spot);
    // The bias along the normal is one more share of a texel.
    let unknown = rounding * inverse + light.texel * (1.5 * doubt + 1e-30);
    let bias = light.normal_offset * (abs(steepness.x) + abs(steepness.y));
    let nearest = own + rise.x + rise.y + bias + slope * unknown;
    let reference = clamp(nearest, 0.0, max(bound, 0.0)) + light.quantum;
    let tile = shadows_tile(light);
    let at = shadows_tile_blend(light, tile, place);
    let share = textureSampleCompareLevel(map, map_sampler, at, tile.layer, reference);
    // Exactly 0 or 1 where all texels agree, however a sampler rounds the sum of their weights.
    let lit = saturate(share * (1.0 + 0x1p-16) - 0x1p-17);
    let on_map = shadows_flat_inside(light, place - 0.5) & (away > 0.0) & shadows_casts(light);
    let seen = select(1.0, lit, on_map);
    let reached = shadows_flat_served(light) & (!spot | (squared <= light.range_squared));
    return select(0.0, seen, reached);
}
