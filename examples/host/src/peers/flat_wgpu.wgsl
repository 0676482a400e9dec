// wgpu's own `shadow` example (examples/features/src/shadow/shader.wgsl, fetch_shadow): a matrix, a
// hardware comparison, no bias in the shader.
@group(1) @binding(0) var peer_map: texture_depth_2d;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerFlatLight;

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let clip = peer_light.clip_from_world * vec4f(position, 1.0);
    if clip.w <= 0.0 {
        return 1.0;
    }
    let across = clip.xyz / clip.w;
    let uv = across.xy * vec2f(0.5, -0.5) + 0.5;
    return textureSampleCompareLevel(peer_map, peer_sampler, uv, across.z);
}
