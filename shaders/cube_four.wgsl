// Four texels of a cube map.

// Whether the texels around all corners within `reach` of this one lie on its face.
fn shadows_cube_whole(receiver: ShadowsCubeReceiver, corner: vec2f, reach: f32) -> bool {
    return all(abs(corner) < vec2f(receiver.light.texels - 0.5 - reach));
}

// Whether casters are nearer than the plane at the texels around a corner: bottom left, bottom right,
// top right, top left. Its depths are `columns` (left, right) and `rows` (top, bottom) together.
fn shadows_cube_blocked(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    corner: vec2f,
    columns: vec2f,
    rows: vec2f,
) -> vec4<bool> {
    let found = shadows_cube_gather(map, map_sampler, receiver, corner);
    let depths = columns.xyyx + rows.yyxx;
    let step = 2.0 * receiver.light.step;
    let s = step * (corner.x + vec4f(-0.5, 0.5, 0.5, -0.5));
    let t = step * (corner.y + vec4f(0.5, 0.5, -0.5, -0.5));
    return shadows_cube_nearer(receiver, depths, found, 1.0 + s * s + t * t);
}

// The receiver as its texels are looked at one by one.
fn shadows_cube_again(receiver: ShadowsCubeReceiver, corner: vec2f, s: vec2f) -> ShadowsCubeReceiver {
    return receiver;
}
