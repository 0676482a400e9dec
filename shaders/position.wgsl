// The order of multiplication that shadow volumes use. Another order rounds differently, and then
// an "equal" depth test against the host's own surfaces fails here and there.
fn shadows_clip_position(
    clip_from_world: mat4x4f,
    world_from_object: mat4x4f,
    position: vec3f,
) -> vec4f {
    return clip_from_world * (world_from_object * vec4f(position, 1.0));
}
