// One texel of a cube map: the one that a point falls on, on whichever face it is.

// The direction of that texel's centre along the world's axes, in texels; `local` is relative to the light.
fn shadows_cube_centre(receiver: ShadowsCubeReceiver, local: vec3f) -> vec3f {
    // The faces' grids are one grid in the three axes, and on each face the major axis stays as it is. Scaled
    // to a little less than half of the map, so that no other axis is rounded to beyond the last texel.
    let a = abs(local);
    let most = max(a.x, max(a.y, a.z));
    let x_major = a.x >= most;
    let y_major = select(a.y >= most, false, x_major);
    let place = local * (receiver.half_size / most) - receiver.centre;
    let texel = round(place);
    return receiver.centre + vec3f(
        select(texel.x, place.x, x_major),
        select(texel.y, place.y, y_major),
        select(place.z, texel.z, x_major | y_major),
    );
}

fn shadows_cube_stored_in(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    direction: vec3f,
) -> f32 {
    let found = vec4f(shadows_cube_fetch(map, map_sampler, receiver, direction));
    let step = 2.0 / size;
    let squared = step * step * dot(direction, direction);
    return shadows_cube_depth(receiver, found, vec4f(squared)).x;
}

// Depth of the receiver's plane, and the depth stored, in the direction of the centre of the texel
// that `local` falls on, a point of the plane.
fn shadows_cube_look(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    local: vec3f,
) -> vec2f {
    let direction = shadows_cube_centre(receiver, local);
    let stored = shadows_cube_stored_in(map, map_sampler, receiver, size, direction);
    // The point is on the plane, but the texel's centre may be beyond the plane's horizon.
    let g = receiver.gradient;
    let depth = receiver.horizon + g.x * direction.x + g.y * direction.y + g.z * direction.z;
    let plane = select(receiver.own, depth, depth > receiver.horizon);
    return vec2f(min(plane, receiver.bound), stored);
}

// How much farther from its light (a sphere) than its blocker a receiver is, as a fraction of the
// blocker's distance: sums of the plane's depths and of the depths stored at the taps that are
// blocked.
fn shadows_cube_gap(receiver: ShadowsCubeReceiver, plane: f32, stored: f32, blocked: f32) -> f32 {
    return stored / plane - 1.0;
}
