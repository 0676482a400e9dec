// The plane of a receiver on a cube map from the derivatives of its position, or from the map. `reach`:
// how far from the receiver a tap's texel may be, in texels and in the world.
fn shadows_cube_derived(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,
    position: vec3f,
    x: vec3f,
    y: vec3f,
    reach: vec2f,
) -> ShadowsCubeDerived {
    let from_light = position - light.position;
    let normal = cross(x, y);
    let squared = dot(normal, normal);
    let facing = dot(normal, from_light);
    let doubt = shadows_cube_doubt(position, x, y) * dot(from_light, from_light);
    // As far as the derivatives' plane may be off where the kernel ends.
    let end = reach.x * 2.0 * shadows_cube_major(from_light) / light.size + reach.y;
    let tilted = abs(facing) - end * sqrt(doubt * squared) / abs(facing);
    let taken = max(tilted, 0.03125 * abs(facing));
    var derived = ShadowsCubeDerived(normal, squared, facing, taken);
    // Gone round once where that says nothing. Not a branch, of which some drivers run both sides.
    let rounds = select(0, 1, 16.0 * doubt > facing * facing);
    for (var i = 0; i < rounds; i++) {
        derived = shadows_cube_mapped(map, map_sampler, light, position, reach, 5 * rounds);
    }
    return derived;
}

// The same from the map.
fn shadows_cube_mapped(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,
    position: vec3f,
    reach: vec2f,
    taps: i32,
) -> ShadowsCubeDerived {
    let from_light = position - light.position;
    let face = shadows_cube_face(from_light);
    // Not 0 at the light itself.
    let major = max(shadows_cube_major(from_light), 1e-30);
    let uv = shadows_cube_across(face, from_light) / major;
    var receiver: ShadowsCubeReceiver;
    receiver.face = face;
    receiver.texel = (uv * 0.5 + 0.5) * light.size;
    receiver.cube = light.cube;
    receiver.quantum = light.quantum;
    receiver.range_over_near = light.range / light.near;
    let own = light.near / major;
    // Four texels of depth from one texel to the next.
    let steepest = 8.0 * own / light.size;
    let found = shadows_cube_slopes(map, map_sampler, receiver, light.size, taps, steepest);
    // Depth is linear in u and v; it is the plane's distance that makes it the receiver's own here.
    let slope = 0.5 * light.size * found.slope;
    let normal = shadows_cube_to_world(face, vec3f(own - dot(slope, uv), slope));
    // Texels around the receiver, and around where it is taken to be.
    let world = reach.y + light.rounding * length(position);
    let texels = reach.x + 0.5 * world * light.size / major;
    let beside = own / (own + texels * found.bend);
    let facing = dot(normal, from_light);
    return ShadowsCubeDerived(normal, dot(normal, normal), facing, beside * abs(facing));
}

fn shadows_cube_stored_at(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    texel: vec2f,
) -> f32 {
    let direction = vec3f(0.5 * size, texel + 0.5 - 0.5 * size);
    let world = shadows_cube_to_world(receiver.face, direction);
    let found = shadows_cube_fetch(map, map_sampler, receiver, world);
    let step = 2.0 / size;
    let squared = step * step * dot(direction, direction);
    return shadows_cube_depth(receiver, vec4f(found), vec4f(squared)).x;
}
