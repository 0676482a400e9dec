// One texel of a cube map.

// The direction of a texel's centre along the receiver's face's axes (forward, right, down), of
// length 1 along the major axis. `texel` counts from the face's corner and may lie beyond its edge:
// there the grid goes on, texel for texel, on the neighbouring face, whose texels have directions
// (and major axes) of their own.
fn shadows_cube_coordinates(size: f32, texel: vec2f) -> vec3f {
    let step = 2.0 / size;
    var uv = clamp((texel + 0.5) * step - 1.0, vec2f(0.5 * step - 3.0), vec2f(3.0 - 0.5 * step));
    var coordinates: vec3f;
    if abs(uv.x) > 1.0 {
        // Beyond a corner no fourth texel exists; the last one along the edge stands in.
        uv.y = clamp(uv.y, 0.5 * step - 1.0, 1.0 - 0.5 * step);
        coordinates = vec3f(2.0 - abs(uv.x), sign(uv.x), uv.y);
    } else if abs(uv.y) > 1.0 {
        coordinates = vec3f(2.0 - abs(uv.y), uv.x, sign(uv.y));
    } else {
        coordinates = vec3f(1.0, uv);
    }
    return coordinates;
}

fn shadows_cube_plane(receiver: ShadowsCubeReceiver, size: f32, texel: vec2f) -> f32 {
    return dot(receiver.plane, shadows_cube_coordinates(size, texel));
}

// Depth of the receiver's plane in a texel's direction (0 or less beyond the plane's horizon), and
// the depth stored there.
fn shadows_cube_depths(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    texel: vec2f,
) -> vec2f {
    let coordinates = shadows_cube_coordinates(size, texel);
    let face = receiver.face;
    let direction = mat3x3f(face.forward, face.right, face.down) * coordinates;
    let found = vec4f(shadows_cube_fetch(map, map_sampler, receiver, direction));
    let stored = shadows_cube_depth(receiver, found, vec4f(dot(coordinates, coordinates))).x;
    return vec2f(dot(receiver.plane, coordinates), stored);
}
