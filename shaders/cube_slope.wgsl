// The normal of a receiver on a cube map from the derivatives of its position, or from the map. `reach`:
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
    let facing = abs(dot(normal, from_light));
    let doubt = shadows_cube_doubt(position, x, y) * length(from_light);
    let a = abs(from_light);
    // As far as the derivatives' plane may be off where the kernel ends.
    let end = reach.x * 2.0 * max(a.x, max(a.y, a.z)) / light.size + reach.y;
    let tilted = max(1.0 - end * doubt * length(normal) / (facing * facing), 0.03125);
    var derived = ShadowsCubeDerived(normal, vec2f(tilted, 0.0));
    // Gone round once where that says nothing. Not a branch, of which some drivers run both sides.
    let rounds = select(0, 1, doubt >= 0.25 * facing);
    for (var i = 0; i < rounds; i++) {
        derived = shadows_cube_mapped(map, map_sampler, light, position, reach, 5 * rounds);
    }
    return derived;
}

// Both from the map.
fn shadows_cube_mapped(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,
    position: vec3f,
    reach: vec2f,
    taps: i32,
) -> ShadowsCubeDerived {
    let from_light = position - light.position;
    let face = shadows_cube_face(from_light, light.size);
    var receiver: ShadowsCubeReceiver;
    receiver.face = face;
    receiver.texel = face.texel;
    receiver.cube = light.cube;
    receiver.quantum = light.quantum;
    receiver.range_over_near = light.range / light.near;
    // Not 0 at the light itself.
    let major = max(dot(face.forward, from_light), 1e-30);
    let own = light.near / major;
    // Four texels of depth from one texel to the next.
    let steepest = 8.0 * own / light.size;
    let found = shadows_cube_slopes(map, map_sampler, receiver, light.size, taps, steepest);
    // Depth is linear in u and v; it is the plane's distance that makes it the receiver's own here.
    let slope = 0.5 * light.size * found.slope;
    let uv = face.texel * (2.0 / light.size) - 1.0;
    let plane = vec3f(own - dot(slope, uv), slope);
    // Texels around the receiver, and around where it is taken to be.
    let world = reach.y + light.rounding * length(position);
    let texels = reach.x + 0.5 * world * light.size / major;
    let beside = own / (own + texels * found.bend);
    let axes = mat3x3f(face.forward, face.right, face.down);
    return ShadowsCubeDerived(axes * plane, vec2f(beside, 0.0));
}

fn shadows_cube_stored_at(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    texel: vec2f,
) -> f32 {
    let uv = (texel + 0.5) * (2.0 / size) - 1.0;
    let face = receiver.face;
    let direction = face.forward + uv.x * face.right + uv.y * face.down;
    let found = shadows_cube_fetch(map, map_sampler, receiver, direction);
    return shadows_cube_depth(receiver, vec4f(found), vec4f(1.0 + dot(uv, uv))).x;
}
