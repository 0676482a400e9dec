// One tap of a disk on a cube map, at the texel that `local` falls on: a point of the receiver's plane along the
// axes of the receiver's face (forward, right, down). Depth of the plane, and the depth stored, there.

// On the receiver's own face.
fn shadows_cube_look(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    local: vec3f,
) -> vec2f {
    let place = local.yz * (receiver.light.texels / local.x) + receiver.light.middle;
    let centre = floor(place) + 0.5;
    let stored = shadows_cube_stored(map, map_sampler, receiver, centre);
    let depth = receiver.corner + dot(receiver.slope, centre);
    return shadows_cube_seen(receiver, depth, stored);
}

// The point is on the plane, but the texel's centre may be beyond the plane's horizon.
fn shadows_cube_seen(receiver: ShadowsCubeReceiver, depth: f32, stored: f32) -> vec2f {
    let plane = select(receiver.own, depth, depth > receiver.horizon);
    return vec2f(min(plane, receiver.bound), stored);
}

// Whether all points of a disk are on that face.
fn shadows_cube_holds(receiver: ShadowsCubeReceiver, disk: ShadowsCubeDisk) -> bool {
    // As far as the disk's end may be from the receiver along any axis, and what is left of the face there.
    let reach = abs(disk.across) + abs(disk.along);
    let room = vec2f(receiver.local.x - reach.x) - abs(receiver.local.yz) - reach.yz;
    return min(room.x, room.y) > 0.0;
}

// On whichever face it is.
fn shadows_cube_look_over(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    local: vec3f,
) -> vec2f {
    // The faces' grids are one grid in the three axes, and on each face the major axis stays as it is. Scaled
    // to a little less than half of the map, so that no other axis is rounded to beyond the last texel.
    let a = abs(local);
    let most = max(a.x, max(a.y, a.z));
    let place = local * (receiver.light.texels / most);
    let texel = floor(place + receiver.light.middle) + (0.5 - receiver.light.middle);
    let direction = select(texel, place, a >= vec3f(most));
    let world = shadows_cube_to_world(receiver.face, direction);
    let found = vec4f(shadows_cube_fetch_in(map, map_sampler, receiver, world));
    let step = 2.0 * receiver.light.step;
    let squared = step * step * dot(direction, direction);
    let stored = shadows_cube_depth(receiver, found, vec4f(squared)).x;
    return shadows_cube_seen(receiver, shadows_cube_at(receiver, direction), stored);
}

// How much farther from its light (a sphere) than its blocker a receiver is, as a fraction of the
// blocker's distance: sums of the plane's depths and of the depths stored at the taps that are
// blocked.
fn shadows_cube_gap(receiver: ShadowsCubeReceiver, plane: f32, stored: f32, blocked: f32) -> f32 {
    return stored / plane - 1.0;
}
