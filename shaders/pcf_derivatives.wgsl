// Normals from screen derivatives of positions. Where a pixel is hardly wider than the rounding of the
// positions, their differences say nothing of the surface, and the map is asked for its slope: docs/numerics.md,
// "Ulps of positions".

struct ShadowsCubeDerived {
    // Of any length and either sign.
    normal: vec3f,
    // The receiver is taken to be nearer to its light: by a factor, and by so much along parallel rays.
    nearer: vec2f,
}

// How what is stored changes from texel to texel, and how much that differs from one side to the other.
struct ShadowsCubeSlopes {
    slope: vec2f,
    bend: f32,
}

// How far rounding may move the end of the cross product of two differences of positions.
fn shadows_cube_doubt(position: vec3f, x: vec3f, y: vec3f) -> f32 {
    // As far as the difference of two positions side by side may be off.
    let a = abs(position);
    let off = 1.2e-7 * max(a.x, max(a.y, a.z));
    // With room for differences that are rounded to nothing.
    return 1.42 * off * sqrt(dot(x, x) + dot(y, y) + off * off);
}

// The slopes of the map around a texel, for a receiver that says which map. Along each axis the lesser
// of two counts: the other may reach over the edge of what the texel shows. `steepest`, with
// twice the slope itself, bounds how much they are taken to differ.
fn shadows_cube_slopes(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    doubtful: bool,
    steepest: f32,
) -> ShadowsCubeSlopes {
    let middle = max(min(floor(receiver.texel), vec2f(size - 2.0)), vec2f(1.0));
    var stored: array<f32, 5>;
    // A loop rather than a branch: drivers that run both sides of a branch leave a loop.
    let end = select(0, 5, doubtful);
    for (var i = 0; i < end; i++) {
        let side = select(1.0, -1.0, (i & 1) == 1);
        let along = select(select(vec2f(0.0), vec2f(1.0, 0.0), i > 0), vec2f(0.0, 1.0), i > 2);
        stored[i] = shadows_cube_stored_at(map, map_sampler, receiver, size, middle + side * along);
    }
    let before = stored[0] - vec2f(stored[1], stored[3]);
    let behind = vec2f(stored[2], stored[4]) - stored[0];
    let slope = select(before, behind, abs(behind) < abs(before));
    let bend = min(abs(behind - before), steepest + 2.0 * abs(slope));
    return ShadowsCubeSlopes(slope, bend.x + bend.y);
}
