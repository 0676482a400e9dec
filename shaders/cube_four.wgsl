// Four texels of a cube map.

// Whether the texels around all corners within `reach` of this one lie on its face.
fn shadows_cube_gathers(size: f32, corner: vec2f, reach: f32) -> bool {
    return all(abs(corner - 0.5 * size) <= vec2f(0.5 * size - 1.0 - reach));
}

// Whether casters are nearer than these depths at the texels around a corner: bottom left, bottom right,
// top right, top left.
fn shadows_cube_blocked(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    corner: vec2f,
    depths: vec4f,
) -> vec4<bool> {
    let uv = corner - 0.5 * size;
    // Halfway between the texel centres, so no rounding of the address picks other texels.
    let direction = vec3f(0.5 * size, uv);
    let found = shadows_cube_gather(map, map_sampler, receiver, direction);
    let step = 2.0 / size;
    let s = step * (uv.x + vec4f(-0.5, 0.5, 0.5, -0.5));
    let t = step * (uv.y + vec4f(0.5, 0.5, -0.5, -0.5));
    return shadows_cube_nearer(receiver, depths, found, 1.0 + s * s + t * t);
}
