// A map that holds near / (distance along the major axis).

// What depths of the plane are raised by: one step of the format.
fn shadows_cube_step(quantum: f32) -> f32 {
    return quantum;
}

// Stored depths.
fn shadows_cube_depth(receiver: ShadowsCubeReceiver, stored: vec4f, squared: vec4f) -> vec4f {
    return stored;
}

// Whether casters are nearer than these depths. `squared` is the squared length of each texel's direction
// where that is 1 along the axis.
fn shadows_cube_nearer(
    receiver: ShadowsCubeReceiver,
    depths: vec4f,
    stored: vec4f,
    squared: vec4f,
) -> vec4<bool> {
    return depths < stored;
}
