// Texels of a cube map.

// The stored depth at a place on the receiver's own face, in texels from its corner.
fn shadows_cube_fetch(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    place: vec2f,
) -> f32 {
    let at = place * receiver.light.step + receiver.tile.corner;
    return textureSampleLevel(map, map_sampler, at, receiver.tile.layer, 0.0).x;
}

// The depth of what is stored there.
fn shadows_cube_stored(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    place: vec2f,
) -> f32 {
    let found = shadows_cube_fetch(map, map_sampler, receiver, place);
    let step = 2.0 * receiver.light.step;
    let from_middle = place - receiver.light.middle;
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
    let light = receiver.light;
    let tile = shadows_cube_tile(light, face);
    let to_face = light.middle * light.step / shadows_cube_major(direction);
    let at = shadows_cube_across(face, direction) * to_face + tile.middle;
    return textureSampleLevel(map, map_sampler, at, tile.layer, 0.0).x;
}
