// Depths of a map that holds distance / range, turned into near / (distance along the major axis):
// `squared` is the squared length of each texel's direction where that is 1 along the axis. Nothing
// stored (1) is infinitely far away, and one step of the format is added to the distance.
fn shadows_cube_depth(receiver: ShadowsCubeReceiver, stored: vec4f, squared: vec4f) -> vec4f {
    let distance = (stored + receiver.quantum) * receiver.range_over_near;
    return select(sqrt(squared) / distance, vec4f(0.0), stored >= vec4f(1.0));
}
