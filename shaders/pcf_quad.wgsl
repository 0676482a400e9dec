// Four texels at once, each compared with the depth of the receiver's plane in its own direction,
// then weighted. (A hardware compare tap has one reference for all four, which on a slope is wrong
// for three of them.) `corner` is the texel corner that the four share.

// 1 or 0 for each of the four, in gather's order: bottom left, bottom right, top right, top left.
fn shadows_cube_four(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    corner: vec2f,
) -> vec4f {
    let step = 2.0 / size;
    let uv = corner * step - 1.0;
    let middle = dot(receiver.plane, vec3f(1.0, uv));
    let across = receiver.plane.y * 0.5 * step;
    let down = receiver.plane.z * 0.5 * step;
    let reference = middle
        + vec4f(-across, across, across, -across)
        + vec4f(down, down, -down, -down);
    let stored = shadows_cube_stored(map, map_sampler, receiver, size, corner);
    let bounded = clamp(reference, vec4f(0.0), vec4f(receiver.bound));
    var lit = select(vec4f(0.0), vec4f(1.0), bounded >= stored);
    // At an edge, or at the plane's horizon: texel by texel. A loop, and one that cannot be unrolled,
    // because drivers that run both sides of a branch leave a loop that no lane is in.
    let whole = shadows_cube_gathers(size, corner) && all(reference > vec4f(receiver.horizon));
    let end = select(4u, 0u, whole);
    for (var i = 0u; i < end; i++) {
        let place = vec2f(select(0.0, 1.0, i == 1u || i == 2u), select(0.0, 1.0, i < 2u));
        let texel = corner - 1.0 + place;
        lit[i] = shadows_cube_texel(map, map_sampler, receiver, size, texel);
    }
    return lit;
}

// One bilinear compare tap. Exactly 1 where all four are 1, which weights that are rounded one by
// one do not give.
fn shadows_cube_quad(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    corner: vec2f,
    weight: vec2f,
) -> f32 {
    let lit = shadows_cube_four(map, map_sampler, receiver, size, corner);
    let top = lit.w + (lit.z - lit.w) * weight.x;
    let bottom = lit.x + (lit.y - lit.x) * weight.x;
    return top + (bottom - top) * weight.y;
}
