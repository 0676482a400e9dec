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

fn shadows_cube_filter(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
) -> f32 {
    let s = shadows_cube_between(receiver);
    // From the receiver to the corner in the middle of the kernel.
    let off = 0.5 - s;
    let corner = receiver.texel + off;
    // Depths of the receiver's plane at texel centres are a sum of one for the column and one for the row.
    let slope = receiver.slope;
    let middle = receiver.own + dot(slope, off);
    // From here to the corners in the middle of the first and the last pairs.
    let reach = f32(shadows_cube_pairs - 1);
    var shadow = 0.0;
    for (var y = 0; y < shadows_cube_pairs; y++) {
        let v = 2.0 * f32(y) - reach;
        let upper = (v - 0.5) * slope.y;
        let lower = (v + 0.5) * slope.y;
        var blocked = vec2f(0.0);
        for (var x = 0; x < shadows_cube_pairs; x++) {
            let u = 2.0 * f32(x) - reach;
            let left = middle + (u - 0.5) * slope.x;
            let right = middle + (u + 0.5) * slope.x;
            let at = corner + vec2f(u, v);
            let behind = shadows_cube_blocked(
                map, map_sampler, receiver, at, vec2f(left, right), vec2f(upper, lower),
            );
            let weights = select(vec4f(0.0), shadows_cube_pair(x, s.x).xyyx, behind);
            blocked += weights.wx + weights.zy;
        }
        shadow += dot(shadows_cube_pair(y, s.y), blocked);
    }
    // At an edge of the map, or where the plane is at its horizon or too near for some texel: texel by texel
    // instead, each with what stands in for it. A loop, and one that cannot be unrolled, because drivers that
    // run both sides of a branch leave a loop that no lane is in; and one for all taps, because they run it
    // once at least.
    let most = (reach + 0.5) * (abs(slope.x) + abs(slope.y));
    let whole = shadows_cube_whole(receiver, corner, reach)
        & (middle - most > receiver.horizon) & (middle + most <= receiver.bound);
    let side = 2 * shadows_cube_pairs;
    let end = select(side * side, 0, whole);
    shadow = select(0.0, shadow, whole);
    let first = corner - f32(shadows_cube_pairs);
    let edge = shadows_cube_again(receiver, corner, s);
    for (var i = 0; i < end; i++) {
        let x = i % side;
        let y = i / side;
        let across = shadows_cube_pair(x / 2, s.x);
        let down = shadows_cube_pair(y / 2, s.y);
        let weight = select(across.x, across.y, (x & 1) == 1) * select(down.x, down.y, (y & 1) == 1);
        let texel = first + vec2f(f32(x), f32(y));
        shadow += weight * (1.0 - shadows_cube_texel(map, map_sampler, edge, texel));
    }
    // Exactly 0 or 1 where all texels agree, however a GPU rounds the products and their sum: stretched
    // around one half by more than that, and cut off. One half stays one half.
    return saturate(1.0 + 0x1p-17 - shadow * shadows_cube_per_weight);
}
