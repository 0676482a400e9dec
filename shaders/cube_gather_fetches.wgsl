// The four stored depths around a corner of texels that is in this direction, each fetched by itself:
// for devices that have no gather (WebGL 2) or a wrong one. Bottom left, bottom right, top right, top
// left.
fn shadows_cube_gather(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    direction: vec3f,
) -> vec4f {
    // Half a texel, so that each fetch is at the middle of one.
    let right = receiver.face.right / size;
    let down = receiver.face.down / size;
    return vec4f(
        shadows_cube_fetch(map, map_sampler, receiver, direction - right + down),
        shadows_cube_fetch(map, map_sampler, receiver, direction + right + down),
        shadows_cube_fetch(map, map_sampler, receiver, direction + right - down),
        shadows_cube_fetch(map, map_sampler, receiver, direction - right - down),
    );
}
