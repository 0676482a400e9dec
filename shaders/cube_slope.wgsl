// The plane of a receiver on a cube map from the derivatives of its position, or from the map. `reach`:
// how far from the receiver a tap's texel may be, in texels and in the world: across the light's rays, and in
// the plane.
fn shadows_cube_derived(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,
    position: vec3f,
    x: vec3f,
    y: vec3f,
    reach: vec4f,
) -> ShadowsCubeDerived {
    let from_light = position - light.position;
    let normal = cross(x, y);
    let squared = dot(normal, normal);
    let facing = dot(normal, from_light);
    let turned = shadows_cube_doubt(position, x, y);
    let doubt = turned * shadows_cube_squared(from_light);
    // As far as the derivatives' plane may be off where the kernel ends. Across the rays that is farther away on
    // the plane, the more it is seen from its edge.
    let end = 0.25 * (reach.xz * (light.texel * shadows_cube_major(from_light)) + reach.yw);
    let facing_squared = 1e-37 + facing * facing;
    let off = end.x * sqrt(doubt * squared) * inverseSqrt(facing_squared) + end.y * sqrt(turned);
    let tilted = abs(facing) - off;
    let taken = max(tilted, 0.03125 * abs(facing));
    var derived = ShadowsCubeDerived(normal, squared, facing, taken);
    // Gone round once where that says nothing, with 5 taps. Not a branch, of which some drivers run both sides.
    let taps = select(0, 5, doubt > facing_squared);
    for (var i = 0; i < taps; i += 5) {
        derived = shadows_cube_mapped(map, map_sampler, light, position, reach, taps);
    }
    return derived;
}

// The same from the map.
fn shadows_cube_mapped(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,
    position: vec3f,
    reach: vec4f,
    taps: i32,
) -> ShadowsCubeDerived {
    let from_light = position - light.position;
    let face = shadows_cube_face(from_light);
    // Not 0 at the light itself.
    let major = max(shadows_cube_major(from_light), 1e-30);
    var receiver: ShadowsCubeReceiver;
    receiver.face = face;
    receiver.texel = shadows_cube_across(face, from_light) * (light.texels / major);
    receiver.light = light;
    receiver.tile = shadows_cube_tile(light, face);
    // Texels as far as rounding may have moved the receiver.
    let per_length = 1.0 / (light.texel * major);
    let moved = light.rounding * length(position) * per_length;
    let step = shadows_cube_stride(light, moved);
    let found = shadows_cube_slopes(map, map_sampler, receiver, step, taps);
    let own = light.depth_per / (light.depth_bias * major);
    // Four texels of depth from one texel to the next.
    let bend = shadows_cube_bend(found, 4.0 * own * light.texel);
    // Depth is linear along the face; it is the plane's distance that makes it the receiver's own here.
    let across = shadows_cube_to_world(face, vec3f(0.0, light.texels * found.slope));
    let forward = own - dot(across, from_light) / major;
    let normal = across + shadows_cube_to_world(face, vec3f(forward, 0.0, 0.0));
    // Texels around the receiver, and around where it is taken to be.
    let texels = reach.x + reach.z + (reach.y + reach.w) * per_length + moved;
    let beside = own / (own + texels * bend);
    let facing = dot(normal, from_light);
    return ShadowsCubeDerived(normal, dot(normal, normal), facing, beside * abs(facing));
}

fn shadows_cube_stored_at(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    texel: vec2f,
) -> f32 {
    return shadows_cube_stored(map, map_sampler, receiver, texel + 0.5 + receiver.light.middle);
}

// The receiver's texel, or the nearest that has others so far away to all sides on the same face.
fn shadows_cube_inner(receiver: ShadowsCubeReceiver, step: f32) -> vec2f {
    let most = receiver.light.middle - step - 0.5;
    return shadows_cube_floor(receiver, clamp(receiver.texel, vec2f(-most), vec2f(most)));
}
