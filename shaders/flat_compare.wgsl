// Whether casters are nearer than these depths at the texels around a corner: bottom left, bottom right,
// top right, top left.
fn shadows_flat_blocked(
    map: texture_2d<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    size: f32,
    corner: vec2f,
    depths: vec4f,
) -> vec4<bool> {
    // What is farther than a directional light's range is not behind what is empty.
    let stored = shadows_flat_stored(map, map_sampler, receiver, size, corner);
    return max(depths, vec4f(0.0)) < stored;
}
