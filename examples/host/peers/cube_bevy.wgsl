// Bevy 0.20's point light with the `Hardware2x2` filter: the receiver moves along its shading normal
// by 0.6 texels and toward the light by 0.08, is projected along the major axis, and one hardware
// comparison blends four texels with that one depth.
@group(1) @binding(0) var peer_map: texture_depth_cube;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

fn peer_major(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let to_light = peer_light.position - position;
    // A texel at the receiver, on the diagonal.
    let texel = 0.6 * 1.4142135 * 2.0 / peer_light.size * peer_major(to_light);
    let moved = position + texel * normal + 0.08 * normalize(to_light);
    let local = moved - peer_light.position;
    let depth = peer_light.near / peer_major(local);
    return textureSampleCompareLevel(peer_map, peer_sampler, local, depth);
}
