// Texels of a cube map.

// The stored depth at a place on the receiver's own face, in texels from its corner.
fn shadows_cube_fetch(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    place: vec2f,
) -> f32 {
    return textureSampleLevel(map, map_sampler, place * receiver.step, receiver.layer, 0.0).x;
}

// The depth of what is stored there.
fn shadows_cube_stored(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    place: vec2f,
) -> f32 {
    let found = shadows_cube_fetch(map, map_sampler, receiver, place);
    let step = 2.0 * receiver.step;
    let from_middle = place - receiver.middle;
    let squared = 1.0 + step * step * dot(from_middle, from_middle);
    return shadows_cube_depth(receiver, vec4f(found), vec4f(squared)).x;
}

// The stored depth on whichever face a direction falls on, along the world's axes.
fn shadows_cube_fetch_in(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    direction: vec3f,
) -> f32 {
    let face = shadows_cube_face(direction);
    let to_face = 0.5 / shadows_cube_major(direction);
    let at = shadows_cube_across(face, direction) * to_face + 0.5;
    return textureSampleLevel(map, map_sampler, at, shadows_cube_layer(receiver.cube, face), 0.0).x;
}
