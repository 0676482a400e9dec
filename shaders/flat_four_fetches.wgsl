// The depths stored in the four texels around a corner, each fetched by itself: for devices that have no
// gather (WebGL 2). Bottom left, bottom right, top right, top left.
fn shadows_flat_stored(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    corner: vec2f,
) -> vec4f {
    let least = corner - 0.5;
    let most = corner + 0.5;
    return vec4f(
        shadows_flat_fetch(map, map_sampler, receiver, vec2f(least.x, most.y)),
        shadows_flat_fetch(map, map_sampler, receiver, most),
        shadows_flat_fetch(map, map_sampler, receiver, vec2f(most.x, least.y)),
        shadows_flat_fetch(map, map_sampler, receiver, least),
    );
}
