// Where a point of a mesh lands in clip space. A host that draws its casters with this very
// function, into an `@invariant` position, gets the same depth bits as the shadow passes: floating
// point is not associative, so (clip * world) * p would differ in the last places.
fn shadows_clip_position(
    clip_from_world: mat4x4f,
    world_from_object: mat4x4f,
    position: vec3f,
) -> vec4f {
    return clip_from_world * (world_from_object * vec4f(position, 1.0));
}
