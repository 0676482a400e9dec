// Normals from screen derivatives of positions. Where a pixel is hardly wider than the rounding of the
// positions, their differences say nothing of the surface, and the map is asked for its slope: docs/numerics.md,
// "Ulps of positions".

// How what is stored changes from texel to texel, and how much that differs from one side to the other.
struct ShadowsCubeSlopes {
    slope: vec2f,
    bend: f32,
}

// How far rounding may move the end of the cross product of two differences of positions, squared.
fn shadows_cube_doubt(position: vec3f, x: vec3f, y: vec3f) -> f32 {
    // As far as the difference of two positions side by side may be off, times the root of 2.
    let a = abs(position);
    let off = 1.7e-7 * max(a.x, max(a.y, a.z));
    // With room for differences that are rounded to nothing.
    return off * off * (dot(x, x) + dot(y, y) + 0.5 * off * off);
}

// The slopes of the map around a texel, for a receiver that says which map. Along each axis the lesser
// of two counts: the other may reach over the edge of what the texel shows. `steepest`, with
// twice the slope itself, bounds how much they are taken to differ. `taps` is 5, or 0 where nothing is
// asked: drivers that run both sides of a branch run a loop once at least.
fn shadows_cube_slopes(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    taps: i32,
    steepest: f32,
) -> ShadowsCubeSlopes {
    let texel = max(min(floor(receiver.texel), vec2f(size - 2.0)), vec2f(1.0));
    // There, and to the left, to the right, above and below.
    var middle = 0.0;
    var around = vec4f(0.0);
    for (var i = 0; i < taps; i++) {
        let side = select(1.0, -1.0, (i & 1) == 1);
        let along = select(select(vec2f(0.0), vec2f(1.0, 0.0), i > 0), vec2f(0.0, 1.0), i > 2);
        let stored = shadows_cube_stored_at(map, map_sampler, receiver, size, texel + side * along);
        middle = select(middle, stored, i == 0);
        around = select(around, vec4f(stored), vec4i(1, 2, 3, 4) == vec4i(i));
    }
    let before = middle - around.xz;
    let behind = around.yw - middle;
    let slope = select(before, behind, abs(behind) < abs(before));
    let bend = min(abs(behind - before), steepest + 2.0 * abs(slope));
    return ShadowsCubeSlopes(slope, bend.x + bend.y);
}
