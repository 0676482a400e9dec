// The four stored depths around a corner of texels of the receiver's face, in texels from the face's middle,
// each fetched by itself: for devices that have no gather (WebGL 2). Bottom left, bottom right, top right, top
// left.
fn shadows_cube_gather(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    corner: vec2f,
) -> vec4f {
    let least = corner + (receiver.light.middle - 0.5);
    let most = corner + (receiver.light.middle + 0.5);
    return vec4f(
        shadows_cube_fetch(map, map_sampler, receiver, vec2f(least.x, most.y)),
        shadows_cube_fetch(map, map_sampler, receiver, most),
        shadows_cube_fetch(map, map_sampler, receiver, vec2f(most.x, least.y)),
        shadows_cube_fetch(map, map_sampler, receiver, least),
    );
}
