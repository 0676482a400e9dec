// Bevy 0.20.1's directional light in one cascade (bevy_pbr: shadows.wesl, sample_directional_cascade): the
// receiver moves along its shading normal by texels and toward the light by a length, then a matrix.
// Which cascade it is, and how two of them blend, is left out.
@group(1) @binding(0) var peer_map: texture_depth_2d;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerFlatLight;

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let across = peer_light.normal_bias * peer_light.texel;
    let moved = position + across * normal + peer_light.bias * peer_light.toward_light;
    let clip = peer_light.clip_from_world * vec4f(moved, 1.0);
    if clip.w <= 0.0 {
        return 1.0;
    }
    let at = clip.xyz / clip.w;
    if any(at.xy < vec2f(-1.0)) || at.z < 0.0 || any(at > vec3f(1.0)) {
        return 1.0;
    }
    return peer_filter(at.xy * vec2f(0.5, -0.5) + 0.5, at.z);
}
