// The plane of a receiver on a flat map from the derivatives of its position, or from the map. `reach`:
// how far from the receiver a tap's texel may be, in texels and in the world: across the light's rays, and in
// the plane.
fn shadows_flat_derived(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,
    position: vec3f,
    x: vec3f,
    y: vec3f,
    reach: vec4f,
) -> ShadowsFlatDerived {
    let spot = shadows_flat_spot(light);
    let from_light = position - light.position;
    let normal = cross(x, y);
    let squared = dot(normal, normal);
    let facing = dot(normal, shadows_flat_ray(light, from_light));
    let distance = select(1.0, dot(from_light, from_light), spot);
    let turned = shadows_flat_doubt(position, x, y);
    let doubt = turned * distance;
    // As far as the derivatives' plane may be off where the kernel ends. Across the rays that is farther away on
    // the plane, the more it is seen from its edge.
    let away = select(1.0, dot(light.forward, from_light), spot);
    let end = 0.25 * (reach.xz * (light.texel * away) + reach.yw);
    let off = end.x * sqrt(doubt * squared) / abs(facing) + end.y * sqrt(turned);
    var derived = ShadowsFlatDerived(normal, squared, facing, off);
    // Gone round once where that says nothing. Not a branch, of which some drivers run both sides.
    let rounds = select(0, 1, doubt > facing * facing);
    for (var i = 0; i < rounds; i++) {
        derived = shadows_flat_mapped(map, map_sampler, light, position, reach, derived, 5 * rounds);
    }
    return derived;
}

// The same from the map, and from what derivatives do tell: how far the normal may be turned.
fn shadows_flat_mapped(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,
    position: vec3f,
    reach: vec4f,
    derivatives: ShadowsFlatDerived,
    taps: i32,
) -> ShadowsFlatDerived {
    let spot = shadows_flat_spot(light);
    let axes = mat3x3f(light.forward, light.right, light.down);
    let from_light = position - light.position;
    let local = from_light * axes;
    // Not by 0 at the light itself.
    let inverse = 1.0 / select(1.0, max(local.x, 1e-30), spot);
    let place = local.yz * (light.texels * inverse);
    var receiver: ShadowsFlatReceiver;
    receiver.light = light;
    receiver.tile = shadows_tile(light);
    receiver.texel = place;
    // Without the bias that is in it.
    let own = light.depth_per / light.depth_bias * inverse;
    // Texels as far as rounding may have moved the receiver.
    let moved = light.rounding * length(position) * light.texels * inverse;
    // Four texels of depth from one texel to the next, or what derivatives do not tell from the light's rays, up to 64.
    let known = abs(derivatives.facing);
    let away = select(1.0, local.x, spot);
    let reached = reach.x * light.texel * away + reach.y;
    let certain = derivatives.squared * reached * away / (derivatives.moved * known);
    // Where there is no normal, `certain` is no number.
    let texels = select(4.0, clamp(certain, 4.0, 64.0), known > 0.0);
    let steepest = texels * light.texel * select(light.depth_per, own * inverse, spot);
    let step = shadows_flat_stride(light, moved);
    let found = shadows_flat_slopes(map, map_sampler, receiver, step, taps);
    // Depth is linear over the map; it is the plane's distance that makes it the receiver's own here.
    let forward = select(light.depth_per, own - dot(found.slope, place), spot);
    let normal = axes * vec3f(forward, light.texels * found.slope);
    let facing = dot(normal, shadows_flat_ray(light, from_light));
    // Texels around the receiver, and around where it is taken to be.
    let world = (reach.y + reach.w) * light.texels * inverse;
    let bend = shadows_flat_bend(found, steepest) * (reach.x + reach.z + world + moved);
    let share = bend / select(light.depth_per, own + bend, spot);
    return ShadowsFlatDerived(normal, dot(normal, normal), facing, abs(facing) * share);
}

fn shadows_flat_stored_at(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    texel: vec2f,
) -> f32 {
    return shadows_flat_depths(map, map_sampler, receiver, texel).y;
}

// The receiver's texel, or the nearest that has others so far away to all sides.
fn shadows_flat_inner(receiver: ShadowsFlatReceiver, step: f32) -> vec2f {
    let most = receiver.light.middle - step - 0.5;
    return shadows_flat_floor(receiver, clamp(receiver.texel, vec2f(-most), vec2f(most)));
}
