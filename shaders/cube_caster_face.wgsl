// After cube_caster.wgsl: everywhere but on wgpu's GL back end.

// The rasteriser's own depth: near / (distance along the major axis).
@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> @builtin(position) vec4f {
    return face.clip_from_light * vec4f(from_light(position, instance), 1.0);
}
