// The depths stored in four texels of a cube map.

// Whether the texels around all corners from `first` to `last` lie on one face.
fn shadows_cube_gathers(size: f32, first: vec2f, last: vec2f) -> bool {
    return all(first >= vec2f(1.0)) && all(last <= vec2f(size - 1.0));
}

// Bottom left, bottom right, top right, top left.
fn shadows_cube_stored(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    corner: vec2f,
) -> vec4f {
    let step = 2.0 / size;
    let uv = corner * step - 1.0;
    let face = receiver.face;
    let direction = face.forward + uv.x * face.right + uv.y * face.down;
    // Halfway between the texel centres, so no rounding of the address picks other texels.
    let found = shadows_cube_gather(map, map_sampler, receiver, size, direction);
    let s = uv.x + 0.5 * step * vec4f(-1.0, 1.0, 1.0, -1.0);
    let t = uv.y + 0.5 * step * vec4f(1.0, 1.0, -1.0, -1.0);
    return shadows_cube_depth(receiver, found, 1.0 + s * s + t * t);
}
