// After cube_caster.wgsl: everywhere but on wgpu's GL back end.

@group(0) @binding(0) var<uniform> face: ShadowsCubeFaceUniform;

// The rasteriser's own depth: near / (distance along the major axis).
@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> @builtin(position) vec4f {
    return face.clip_from_light * vec4f(from_light(position, instance), 1.0);
}

@vertex
fn vertex_distance(@location(0) position: vec3f, instance: Instance) -> Fragment {
    let relative = from_light(position, instance);
    return Fragment(face.clip_from_light * vec4f(relative, 1.0), relative);
}

// Distance from the light as a fraction of its range (Gerasimov 2004).
@fragment
fn fragment_distance(in: Fragment) -> @builtin(frag_depth) f32 {
    return length(in.from_light) / face.range;
}
