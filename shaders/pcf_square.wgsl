// Square kernels from taps of 2x2 texels (Reeves, Salesin and Cook, "Rendering Antialiased Shadows
// with Depth Maps", 1987: compare first, filter the results; Castano, "Shadow Mapping Summary", The
// Witness, 2013: one bilinear tap takes the place of four weighted ones). There the hardware blends
// four comparisons with one reference, which on a slope is wrong for three of them; these gather
// the four, so that each has the depth of the receiver's plane in its own direction, and the weights
// are those that the tap positions come to.
//
// Along each axis there are `shadows_cube_pairs` pairs of texels. Their weights are linear in the
// place s between texels: `shadows_cube_first` and `shadows_cube_second` hold the constants for the
// first and the second texel of each pair, the names with `_s` the factors of s.

// Weights of the two texels of pair `i`.
fn shadows_cube_pair(i: i32, s: f32) -> vec2f {
    return vec2f(shadows_cube_first[i], shadows_cube_second[i])
        + s * vec2f(shadows_cube_first_s[i], shadows_cube_second_s[i]);
}

// Comparisons of the four texels around a corner with the plane's depths, in gather's order: bottom
// left, bottom right, top right, top left. 1 where a caster is nearer, else 0.
fn shadows_cube_blocked(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    corner: vec2f,
) -> vec4f {
    let step = 2.0 / size;
    let half_step = receiver.plane.yz / size;
    let middle = dot(receiver.plane, vec3f(1.0, corner * step - 1.0));
    let reference = middle
        + half_step.x * vec4f(-1.0, 1.0, 1.0, -1.0)
        + half_step.y * vec4f(1.0, 1.0, -1.0, -1.0);
    let stored = shadows_cube_stored(map, map_sampler, receiver, size, corner);
    let bounded = clamp(reference, vec4f(0.0), vec4f(receiver.bound));
    return select(vec4f(1.0), vec4f(0.0), bounded >= stored);
}

fn shadows_cube_filter(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
) -> f32 {
    let corner = floor(receiver.texel + 0.5);
    let s = receiver.texel + 0.5 - corner;
    // The corners in the middle of the first and the last pairs.
    let reach = f32(shadows_cube_pairs - 1);
    let first = corner - reach;
    var shadow = 0.0;
    for (var y = 0; y < shadows_cube_pairs; y++) {
        let down = shadows_cube_pair(y, s.y);
        for (var x = 0; x < shadows_cube_pairs; x++) {
            let at = first + 2.0 * vec2f(f32(x), f32(y));
            let blocked = shadows_cube_blocked(map, map_sampler, receiver, size, at);
            let weights = shadows_cube_pair(x, s.x).xyyx * down.yyxx;
            shadow += dot(weights, blocked);
        }
    }
    // At an edge of the map, or at the plane's horizon: texel by texel instead, each with what stands
    // in for it. A loop, and one that cannot be unrolled, because drivers that run both sides of a
    // branch leave a loop that no lane is in; and one for all taps, because they run it once at least.
    let extent = (reach + 0.5) * 2.0 / size;
    let lowest = dot(receiver.plane, vec3f(1.0, corner * 2.0 / size - 1.0))
        - extent * (abs(receiver.plane.y) + abs(receiver.plane.z));
    let whole = shadows_cube_gathers(size, first, corner + reach) && lowest > receiver.horizon;
    let side = 2 * shadows_cube_pairs;
    let end = select(side * side, 0, whole);
    shadow = select(0.0, shadow, whole);
    for (var i = 0; i < end; i++) {
        let x = i % side;
        let y = i / side;
        let across = shadows_cube_pair(x / 2, s.x);
        let down = shadows_cube_pair(y / 2, s.y);
        let weight = select(across.x, across.y, (x & 1) == 1) * select(down.x, down.y, (y & 1) == 1);
        let texel = first - 1.0 + vec2f(f32(x), f32(y));
        shadow += weight * (1.0 - shadows_cube_texel(map, map_sampler, receiver, size, texel));
    }
    // Exactly 0 or 1 where all texels agree, however a GPU rounds the products and their sum: stretched
    // around one half by more than that, and cut off. One half stays one half.
    return saturate(1.0 + 0x1p-17 - shadow * shadows_cube_per_weight);
}
