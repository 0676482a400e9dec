// One bilinear compare tap: four texels, each compared with the depth of the receiver's plane in
// its own direction, then weighted. (A hardware compare tap has one reference for all four, which
// on a slope is wrong for three of them.) `corner` is the texel corner that the four share.

// Exactly 1 where all four are 1, which weights that are rounded one by one do not give.
fn shadows_blend(a: f32, b: f32, c: f32, d: f32, weight: vec2f) -> f32 {
    let top = a + (b - a) * weight.x;
    let bottom = c + (d - c) * weight.x;
    return top + (bottom - top) * weight.y;
}

fn shadows_cube_quad(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsReceiver,
    size: f32,
    corner: vec2f,
    weight: vec2f,
) -> f32 {
    if all(corner >= vec2f(1.0)) && all(corner <= vec2f(size - 1.0)) {
        let step = 2.0 / size;
        let uv = corner * step - 1.0;
        let face = receiver.face;
        let direction = face.forward + uv.x * face.right + uv.y * face.down;
        // Halfway between the texel centres, so no rounding of the address picks other texels.
        let found = shadows_cube_gather(map, map_sampler, receiver, direction);
        let s = uv.x + 0.5 * step * vec4f(-1.0, 1.0, 1.0, -1.0);
        let t = uv.y + 0.5 * step * vec4f(1.0, 1.0, -1.0, -1.0);
        let stored = shadows_cube_depth(receiver, found, 1.0 + s * s + t * t);
        let middle = dot(receiver.plane, vec3f(1.0, uv));
        let across = receiver.plane.y * 0.5 * step;
        let down = receiver.plane.z * 0.5 * step;
        // Gather's order: bottom left, bottom right, top right, top left.
        let reference = middle
            + vec4f(-across, across, across, -across)
            + vec4f(down, down, -down, -down);
        let lit = select(vec4f(0.0), vec4f(1.0), max(reference, vec4f(0.0)) >= stored);
        return shadows_blend(lit.w, lit.z, lit.x, lit.y, weight);
    }
    let first = corner - 1.0;
    let a = shadows_cube_texel(map, map_sampler, receiver, size, first);
    let b = shadows_cube_texel(map, map_sampler, receiver, size, first + vec2f(1.0, 0.0));
    let c = shadows_cube_texel(map, map_sampler, receiver, size, first + vec2f(0.0, 1.0));
    let d = shadows_cube_texel(map, map_sampler, receiver, size, first + vec2f(1.0, 1.0));
    return shadows_blend(a, b, c, d, weight);
}
