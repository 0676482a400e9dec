// Normals from screen derivatives of positions. Where a pixel is hardly wider than the rounding of the
// positions, their differences say nothing of the surface, and the map is asked for its slope: docs/numerics.md,
// "Ulps of positions".

// How what is stored changes from texel to texel, and by how much that differs from one side to the other.
struct ShadowsCubeSlopes {
    slope: vec2f,
    bend: vec2f,
}

// How far rounding may move the end of the cross product of two differences of positions, times 4, squared.
fn shadows_cube_doubt(position: vec3f, x: vec3f, y: vec3f) -> f32 {
    // As far as the difference of two positions side by side may be off, times the root of 2 and 4.
    let a = abs(position);
    let off = 6.8e-7 * max(a.x, max(a.y, a.z));
    let squared = off * off;
    // With room for differences that are rounded to nothing.
    let s = squared + x.x * x.x + x.y * x.y + x.z * x.z + y.x * y.x + y.y * y.y + y.z * y.z;
    return squared * s;
}

// The slopes of the map around a texel, for a receiver that says which map, to texels `step` away: as far as
// rounding has likely moved the receiver. Along each axis the lesser of two counts: the other may reach over the
// edge of what the texel shows. `taps` is 5, or 0 where nothing is asked: drivers that run both sides of a branch
// run a loop once at least.
fn shadows_cube_slopes(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    step: f32,
    taps: i32,
) -> ShadowsCubeSlopes {
    let texel = shadows_cube_inner(receiver, step);
    // There, and to the left, to the right, above and below.
    var middle = 0.0;
    var around = vec4f(0.0);
    for (var i = 0; i < taps; i++) {
        let side = select(step, -step, (i & 1) == 1);
        let along = select(select(vec2f(0.0), vec2f(1.0, 0.0), i > 0), vec2f(0.0, 1.0), i > 2);
        let stored = shadows_cube_stored_at(map, map_sampler, receiver, texel + side * along);
        middle = select(middle, stored, i == 0);
        around = select(around, vec4f(stored), vec4i(1, 2, 3, 4) == vec4i(i));
    }
    let before = (middle - around.xz) / step;
    let behind = (around.yw - middle) / step;
    let slope = select(before, behind, abs(behind) < abs(before));
    return ShadowsCubeSlopes(slope, abs(behind - before));
}

// How far apart these texels are: a quarter of what rounding may have moved the receiver, which most are within.
fn shadows_cube_stride(light: ShadowsLight, moved: f32) -> f32 {
    return clamp(floor(0.25 * moved), 1.0, floor(0.5 * light.middle));
}

// How much they are taken to differ: by no more than `steepest` and twice the slope itself.
fn shadows_cube_bend(found: ShadowsCubeSlopes, steepest: f32) -> f32 {
    let bend = min(found.bend, steepest + 2.0 * abs(found.slope));
    return bend.x + bend.y;
}
