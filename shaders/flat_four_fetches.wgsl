// The depths stored in the four texels around a corner, each fetched by itself: for devices that have no
// gather (WebGL 2). Bottom left, bottom right, top right, top left.
fn shadows_flat_stored(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    size: f32,
    corner: vec2f,
) -> vec4f {
    let least = (corner - 0.5) * receiver.step;
    let most = (corner + 0.5) * receiver.step;
    return vec4f(
        textureSampleLevel(map, map_sampler, vec2f(least.x, most.y), 0, 0.0).x,
        textureSampleLevel(map, map_sampler, most, 0, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2f(most.x, least.y), 0, 0.0).x,
        textureSampleLevel(map, map_sampler, least, 0, 0.0).x,
    );
}
