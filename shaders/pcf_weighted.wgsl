// Weighted square kernels from taps of 2x2 texels (Castano, "Shadow Mapping Summary", The Witness,
// 2013): one bilinear tap takes the place of four weighted ones. His taps let the hardware blend
// four comparisons with one reference; these gather the four, so that each has its own, and the
// weights are those that his tap positions come to. Along each axis they are linear in the place s
// between texels: `first` and `second` hold the constants and `first_s`, `second_s` the factors of
// s for the first and the second texel of each pair.
fn shadows_cube_weighted(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    pairs: i32,
    first: vec4f,
    first_s: vec4f,
    second: vec4f,
    second_s: vec4f,
) -> f32 {
    let corner = floor(receiver.texel + 0.5);
    let s = receiver.texel + 0.5 - corner;
    let start = corner + 1.0 - f32(pairs);
    var shadow = 0.0;
    var sum = 0.0;
    for (var y = 0; y < pairs; y++) {
        let down = vec2f(first[y] + first_s[y] * s.y, second[y] + second_s[y] * s.y);
        for (var x = 0; x < pairs; x++) {
            let across = vec2f(first[x] + first_s[x] * s.x, second[x] + second_s[x] * s.x);
            let at = start + 2.0 * vec2f(f32(x), f32(y));
            let lit = shadows_cube_four(map, map_sampler, receiver, size, at);
            let weights = across.xyyx * down.yyxx;
            shadow += dot(weights, 1.0 - lit);
            sum += dot(weights, vec4f(1.0));
        }
    }
    // Shadow over the sum of the same products: exactly 0 or 1 where all texels agree.
    return 1.0 - shadow / sum;
}
