// Four texels of a cube map at once.

// Whether the four texels around a corner lie on one face.
fn shadows_cube_gathers(size: f32, corner: vec2f) -> bool {
    return all(corner >= vec2f(1.0)) && all(corner <= vec2f(size - 1.0));
}

fn shadows_cube_gather(
    map: texture_cube<f32>,
    map_sampler: sampler,
    receiver: ShadowsCubeReceiver,
    size: f32,
    corner: vec2f,
) -> vec4f {
    let uv = corner * (2.0 / size) - 1.0;
    let face = receiver.face;
    return textureGather(0, map, map_sampler, face.forward + uv.x * face.right + uv.y * face.down);
}
