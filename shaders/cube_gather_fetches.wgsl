// The four stored depths around a corner of texels that is in this direction along the face's axes, each
// fetched by itself: for devices that have no gather (WebGL 2) or a wrong one. Bottom left, bottom right,
// top right, top left.
fn shadows_cube_gather(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    direction: vec3f,
) -> vec4f {
    // Each at the middle of its texel.
    let face = receiver.face;
    let a = shadows_cube_to_world(face, direction + vec3f(0.0, -0.5, 0.5));
    let b = shadows_cube_to_world(face, direction + vec3f(0.0, 0.5, 0.5));
    let c = shadows_cube_to_world(face, direction + vec3f(0.0, 0.5, -0.5));
    let d = shadows_cube_to_world(face, direction + vec3f(0.0, -0.5, -0.5));
    return vec4f(
        shadows_cube_fetch(map, map_sampler, receiver, a),
        shadows_cube_fetch(map, map_sampler, receiver, b),
        shadows_cube_fetch(map, map_sampler, receiver, c),
        shadows_cube_fetch(map, map_sampler, receiver, d),
    );
}
