// What most tutorials show: distance over range in a cube map of floats, one tap, a constant bias.
@group(1) @binding(0) var peer_map: texture_cube<f32>;
@group(1) @binding(1) var peer_sampler: sampler;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let from_light = position - peer_light.position;
    let stored = textureSampleLevel(peer_map, peer_sampler, from_light, 0.0).x * peer_light.range;
    return select(0.0, 1.0, length(from_light) - 0.15 <= stored);
}
