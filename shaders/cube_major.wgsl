// Depths of a map that holds near / (distance along the major axis), less one step of its format.
fn shadows_cube_depth(receiver: ShadowsCubeReceiver, stored: vec4f, squared: vec4f) -> vec4f {
    return stored - receiver.quantum;
}
