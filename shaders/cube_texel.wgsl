// One texel of a cube map, by its place on the receiver's face.

// The direction of a texel's centre along the receiver's face's axes (forward, right, down), in texels.
// `texel` counts from the face's middle and may lie beyond its edge: there the grid goes on, texel for
// texel, on the neighbouring face, whose texels have directions (and major axes) of their own.
fn shadows_cube_coordinates(receiver: ShadowsCubeReceiver, texel: vec2f) -> vec3f {
    let half_size = receiver.light.texels;
    var uv = texel + 0.5;
    // Beyond a corner no fourth texel exists; the last one along the edge stands in.
    let most = select(half_size + 64.0, half_size - 0.5, abs(uv.x) > half_size);
    uv.y = clamp(uv.y, -most, most);
    let on_face = clamp(uv, vec2f(-half_size), vec2f(half_size));
    let over = abs(uv) - abs(on_face);
    return vec3f(half_size - over.x - over.y, on_face);
}

fn shadows_cube_plane(receiver: ShadowsCubeReceiver, texel: vec2f) -> f32 {
    return shadows_cube_at(receiver, shadows_cube_coordinates(receiver, texel));
}

// Depth of the receiver's plane in a texel's direction (0 or less beyond the plane's horizon), and
// the depth stored there.
fn shadows_cube_depths(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    texel: vec2f,
) -> vec2f {
    let coordinates = shadows_cube_coordinates(receiver, texel);
    let direction = shadows_cube_to_world(receiver.face, coordinates);
    let found = vec4f(shadows_cube_fetch_in(map, map_sampler, receiver, direction));
    // The major axis of a texel beyond the edge is another one.
    let step = 2.0 * receiver.light.step;
    let squared = step * step * dot(coordinates, coordinates);
    let stored = shadows_cube_depth(receiver, found, vec4f(squared)).x;
    return vec2f(shadows_cube_at(receiver, coordinates), stored);
}
