// After caster_places.wgsl: depth of casters on one face of a cube map, or on a flat map. What all back ends
// share.

struct ShadowsCubeFaceUniform {
    clip_from_light: mat4x4f,
    range: f32,
    // Of the map's side, where that is 2 wide.
    texel: f32,
}

@group(0) @binding(0) var<uniform> face: ShadowsCubeFaceUniform;

fn clip_position(position: vec3f, instance: Instance) -> vec4f {
    return face.clip_from_light * vec4f(by_instance(position, instance), 1.0);
}

// Distance from the light as a fraction of its range (Gerasimov 2004), on the ray through the texel's centre.
// A position that is interpolated lies beside that ray by as much as the vertices were snapped.
@fragment
fn fragment_distance(@builtin(position) pixel: vec4f) -> @builtin(frag_depth) f32 {
    let ray = vec3f(pixel.xy * face.texel - 1.0, 1.0);
    return length(ray) / (pixel.w * face.range);
}
