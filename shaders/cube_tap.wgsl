// One tap of a disk: the texel that a point falls on, on whichever face it is.

// Depth of the receiver's plane, and the depth stored, in the direction of the centre of the texel
// that `local` falls on; `local` is a point of the plane relative to the light.
fn shadows_cube_look(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    local: vec3f,
) -> vec2f {
    // The faces' grids are one grid in the three axes: texel centres are symmetric about 0. So all
    // three are rounded to it, and the one along the major axis put back, without a branch.
    let a = abs(local);
    let x_is_major = a.x >= a.y && a.x >= a.z;
    let y_is_major = !x_is_major && a.y >= a.z;
    let major = vec3<bool>(x_is_major, y_is_major, !x_is_major && !y_is_major);
    let on_cube = local / max(a.x, max(a.y, a.z));
    let texel = clamp(floor((on_cube * 0.5 + 0.5) * size), vec3f(0.0), vec3f(size - 1.0));
    let direction = select((texel + 0.5) * (2.0 / size) - 1.0, sign(local), major);
    let found = vec4f(shadows_cube_fetch(map, map_sampler, receiver, direction));
    let stored = shadows_cube_depth(receiver, found, vec4f(dot(direction, direction))).x;
    // The point is on the plane, but the texel's centre may be beyond the plane's horizon.
    let depth = dot(receiver.gradient, direction);
    let plane = select(receiver.own, depth, depth > receiver.horizon);
    return vec2f(min(plane, receiver.bound), stored);
}

// How much farther from its light (a sphere) than its blocker a receiver is, as a fraction of the
// blocker's distance: sums of the plane's depths and of the depths stored at the taps that are
// blocked.
fn shadows_cube_gap(receiver: ShadowsCubeReceiver, plane: f32, stored: f32, blocked: f32) -> f32 {
    return stored / plane - 1.0;
}
