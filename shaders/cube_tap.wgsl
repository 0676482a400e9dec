// One tap of a disk: the texel that a point falls on, found again on whichever face it is.

// Depth of the receiver's plane, and the depth stored, in the direction of the centre of the texel
// that `local` falls on; `local` is a point of the plane relative to the light, along the axes of
// the receiver's face (forward, right, down).
fn shadows_cube_look(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    local: vec3f,
) -> vec2f {
    let step = 2.0 / size;
    var coordinates: vec3f;
    if max(abs(local.y), abs(local.z)) < local.x {
        let texel = min(floor((local.yz / local.x * 0.5 + 0.5) * size), vec2f(size - 1.0));
        coordinates = vec3f(1.0, (texel + 0.5) * step - 1.0);
    } else {
        // Another face, in the same axes: its grid is the same, turned.
        let face = shadows_cube_face(local, size);
        let uv = (clamp(floor(face.texel), vec2f(0.0), vec2f(size - 1.0)) + 0.5) * step - 1.0;
        coordinates = face.forward + uv.x * face.right + uv.y * face.down;
    }
    let axes = receiver.face;
    let direction = mat3x3f(axes.forward, axes.right, axes.down) * coordinates;
    let found = vec4f(shadows_cube_fetch(map, map_sampler, receiver, direction));
    let stored = shadows_cube_depth(receiver, found, vec4f(dot(coordinates, coordinates))).x;
    return vec2f(clamp(dot(receiver.plane, coordinates), 0.0, receiver.bound), stored);
}

// How much farther from its light (a sphere) than its blocker a receiver is, as a fraction of the
// blocker's distance: sums of the plane's depths and of the depths stored at the taps that are
// blocked.
fn shadows_cube_gap(receiver: ShadowsCubeReceiver, plane: f32, stored: f32, blocked: f32) -> f32 {
    return stored / plane - 1.0;
}
