// On which side of a triangle the light lies. The one predicate behind every way to find silhouettes;
// `light_side.rs` follows it operation by operation.

// A power of two that brings the largest component into [1, 2): exact, and no product of three
// such vectors can leave the range of f32 however small or large the mesh is.
fn exact_scale(v: vec3f) -> f32 {
    let largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    let exponent = bitcast<u32>(largest) & 0x7f800000u;
    return bitcast<f32>(0x7f000000u - min(exponent, 0x7e800000u));
}

// In this order on every device, which `dot` would leave open.
fn sum3(v: vec3f) -> f32 {
    return (v.x + v.y) + v.z;
}

// The same numbers, of which no compiler knows that they are: what was summed before this stays summed
// before it. `zero` is 0, which only the buffer says. Without it a driver that reassociates sums may add
// a light's remainder to the light itself, of which it is too small to be a part.
fn settled(v: vec3f, zero: u32) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(v) ^ vec3u(zero));
}

// sign(det(b - a, c - a, light - w a)), and 0 where rounding could have changed the sign.
//
// Nine roundings lie on the longest path (differences 1 + 1 + 2, products 2, sums 3), so the error
// is below 10 * 2^-24 times the determinant's permanent (the bound of Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997, with one more difference).
fn light_side(a: vec3f, b: vec3f, c: vec3f, light: vec4f, rest: vec3f, zero: u32) -> i32 {
    var u = b - a;
    var v = c - a;
    let toward = settled(light.xyz - light.w * a, zero);
    var r = toward + rest;
    u *= exact_scale(u);
    v *= exact_scale(v);
    let scale = exact_scale(r);
    let r_bound = (abs(toward) + abs(rest)) * scale;
    r *= scale;
    let p = u.yzx * v.zxy;
    let q = u.zxy * v.yzx;
    let det = sum3((p - q) * r);
    let bound = sum3((abs(p) + abs(q)) * r_bound) * (10.0 / 16777216.0);
    return select(0, 1, det > bound) - select(0, 1, det < -bound);
}

// What a triangle counts, by the side on which the light lies: with 0 only if it faces the light,
// with 1 whichever way it faces, with 2 only if it is turned away.
fn counted(side: i32, both_sides: u32) -> i32 {
    return clamp(side, select(-1, 0, both_sides == 0u), select(1, 0, both_sides == 2u));
}
