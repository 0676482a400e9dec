// One bilinear compare tap: four texels, each compared with the depth of the receiver's plane in
// its own direction, then weighted. (A hardware compare tap has one reference for all four, which
// on a slope is wrong for three of them.) `corner` is the texel corner that the four share.

fn shadows_cube_quad(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsReceiver,
    size: f32,
    corner: vec2f,
    weight: vec2f,
) -> f32 {
    let low = 1.0 - weight;
    if all(corner >= vec2f(1.0)) && all(corner <= vec2f(size - 1.0)) {
        let step = 2.0 / size;
        let uv = corner * step - 1.0;
        let face = receiver.face;
        let direction = face.forward + uv.x * face.right + uv.y * face.down;
        // Halfway between the texel centres, so no rounding of the address picks other texels.
        let stored = textureGather(0, map, map_sampler, direction);
        let middle = dot(receiver.plane, vec3f(1.0, uv));
        let across = receiver.plane.y * 0.5 * step;
        let down = receiver.plane.z * 0.5 * step;
        // Gather's order: bottom left, bottom right, top right, top left.
        let reference = middle
            + vec4f(-across, across, across, -across)
            + vec4f(down, down, -down, -down);
        let lit = select(vec4f(0.0), vec4f(1.0), max(reference, vec4f(0.0)) >= stored);
        let share = vec4f(low.x, weight.x, weight.x, low.x)
            * vec4f(weight.y, weight.y, low.y, low.y);
        return dot(lit, share);
    }
    let first = corner - 1.0;
    let a = shadows_cube_texel(map, map_sampler, receiver, size, first);
    let b = shadows_cube_texel(map, map_sampler, receiver, size, first + vec2f(1.0, 0.0));
    let c = shadows_cube_texel(map, map_sampler, receiver, size, first + vec2f(0.0, 1.0));
    let d = shadows_cube_texel(map, map_sampler, receiver, size, first + vec2f(1.0, 1.0));
    return mix(mix(a, b, weight.x), mix(c, d, weight.x), weight.y);
}
