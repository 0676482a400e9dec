// A map that holds distance / range.

// One step of the format is added to the distance that is stored, none to depths of the plane.
fn shadows_cube_step(quantum: f32) -> f32 {
    return 0.0;
}

// What is stored as near / (distance along the major axis): `squared` is the squared length of each
// texel's direction where that is 1 along the axis. Nothing stored (1) is infinitely far away.
fn shadows_cube_depth(receiver: ShadowsCubeReceiver, stored: vec4f, squared: vec4f) -> vec4f {
    let distance = (stored + receiver.light.quantum) * receiver.light.forward.z;
    return select(sqrt(squared) / distance, vec4f(0.0), stored >= vec4f(1.0));
}

// Whether casters are nearer than these depths, which are not below 0: both sides squared, without a root
// or a quotient.
fn shadows_cube_nearer(
    receiver: ShadowsCubeReceiver,
    depths: vec4f,
    stored: vec4f,
    squared: vec4f,
) -> vec4<bool> {
    let share = depths * ((stored + receiver.light.quantum) * receiver.light.forward.z);
    return (share * share < squared) & (stored < vec4f(1.0));
}
