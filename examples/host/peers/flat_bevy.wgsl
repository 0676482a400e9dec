// Bevy 0.20's flat maps with the `Hardware2x2` filter: normal offset and depth bias in texels, a
// matrix, one hardware comparison.
@group(1) @binding(0) var peer_map: texture_depth_2d;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerFlatLight;

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let moved = position + 1.8 * peer_light.texel * normal + 0.02 * peer_light.toward_light;
    let clip = peer_light.clip_from_world * vec4f(moved, 1.0);
    if clip.w <= 0.0 {
        return 1.0;
    }
    let across = clip.xyz / clip.w;
    let outside = any(abs(across.xy) > vec2f(1.0)) || across.z < 0.0 || across.z > 1.0;
    if outside {
        return 1.0;
    }
    let uv = across.xy * vec2f(0.5, -0.5) + 0.5;
    return textureSampleCompareLevel(peer_map, peer_sampler, uv, across.z);
}
