// The normal of a receiver on a flat map from the derivatives of its position, or from the map. `reach`:
// how far from the receiver a tap's texel may be, in texels and in the world.
fn shadows_flat_derived(
    map: texture_2d<f32>,
    map_sampler: sampler,
    light: ShadowsFlatLight,
    position: vec3f,
    x: vec3f,
    y: vec3f,
    reach: vec2f,
) -> ShadowsFlatDerived {
    let from_light = position - light.position;
    let spot = light.perspective > 0.5;
    let ray = select(light.forward, from_light, spot);
    let normal = cross(x, y);
    let facing = abs(dot(normal, ray));
    let doubt = sqrt(shadows_flat_doubt(position, x, y)) * length(ray);
    let away = select(1.0, dot(light.forward, from_light), spot);
    // As far as the derivatives' plane may be off where the kernel ends, against the distance.
    let end = reach.x * 2.0 * away / (light.size * light.scale) + reach.y;
    let shift = end * doubt * length(normal) / (facing * facing);
    let tilted = select(vec2f(1.0, shift), vec2f(max(1.0 - shift, 0.03125), 0.0), spot);
    var derived = ShadowsFlatDerived(normal, tilted);
    // Gone round once where that says nothing. Not a branch, of which some drivers run both sides.
    let rounds = select(0, 1, doubt >= 0.25 * facing);
    for (var i = 0; i < rounds; i++) {
        derived = shadows_flat_mapped(map, map_sampler, light, position, reach, 5 * rounds);
    }
    return derived;
}

// Both from the map.
fn shadows_flat_mapped(
    map: texture_2d<f32>,
    map_sampler: sampler,
    light: ShadowsFlatLight,
    position: vec3f,
    reach: vec2f,
    taps: i32,
) -> ShadowsFlatDerived {
    let axes = mat3x3f(light.forward, light.right, light.down);
    let spot = light.perspective > 0.5;
    let local = (position - light.position) * axes;
    let away = select(1.0, local.x, spot);
    let uv = local.yz * light.scale / away;
    var receiver: ShadowsFlatReceiver;
    receiver.texel = (uv * 0.5 + 0.5) * light.size;
    // Not by 0 at the light itself.
    let own = light.near / max(local.x, 1e-30);
    // Four texels of depth from one texel to the next.
    let steepest = 8.0 / (light.size * light.scale) * select(1.0 / light.range, own / away, spot);
    let found = shadows_flat_slopes(map, map_sampler, receiver, light.size, taps, steepest);
    // Depth is linear in u and v; it is the plane's distance that makes it the receiver's own here.
    let slope = 0.5 * light.size * found.slope;
    let plane = select(1.0 / light.range, own - dot(slope, uv), spot);
    // Texels around the receiver, and around where it is taken to be.
    let world = reach.y + light.rounding * length(position);
    let texels = reach.x + 0.5 * world * light.size * light.scale / away;
    let bend = texels * found.bend;
    let beside = select(vec2f(1.0, bend * light.range), vec2f(own / (own + bend), 0.0), spot);
    return ShadowsFlatDerived(axes * vec3f(plane, light.scale * slope), beside);
}

fn shadows_flat_stored_at(
    map: texture_2d<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    size: f32,
    texel: vec2f,
) -> f32 {
    return shadows_flat_depths(map, map_sampler, receiver, size, texel).y;
}
