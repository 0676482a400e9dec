// Two axes across a unit vector, and the vector (Duff et al., "Building an Orthonormal Basis, Revisited",
// 2017), as Bevy has them: the sign of zero counts.
fn peer_axes(z: vec3f) -> mat3x3f {
    let sign = bitcast<f32>(0x3f800000u | (bitcast<u32>(z.z) & 0x80000000u));
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    let x = vec3f(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
    let y = vec3f(b, sign + z.y * z.y * a, -z.y);
    return mat3x3f(x, y, z);
}
