// After cube_caster.wgsl: everywhere but on wgpu's GL back end.

// The rasteriser's own depth: near / (distance along the major axis).
@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> @builtin(position) vec4f {
    return clip_position(position, instance);
}

// One of many that the host places in its own buffer, and then as a whole.
@vertex
fn vertex_columns(
    @location(0) position: vec3f,
    instance: Instance,
    host: HostColumns,
) -> @builtin(position) vec4f {
    return clip_position(by_columns(position, host), instance);
}

@vertex
fn vertex_rows(
    @location(0) position: vec3f,
    instance: Instance,
    host: HostRows,
) -> @builtin(position) vec4f {
    return clip_position(by_rows(position, host), instance);
}
