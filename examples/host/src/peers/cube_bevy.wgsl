// Bevy 0.20.1's point light with the `Hardware2x2` filter (bevy_pbr: shadows.wesl, fetch_point_shadow):
// the receiver moves along its shading normal by texels and toward the light by a length, is projected
// along the major axis, and one hardware comparison blends four texels with that one depth.
@group(1) @binding(0) var peer_map: texture_depth_cube;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

fn peer_major(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let to_light = peer_light.position - position;
    let across = peer_light.normal_bias * peer_major(to_light);
    let moved = position + across * normal + peer_light.bias * normalize(to_light);
    let local = moved - peer_light.position;
    let clip = peer_light.projection.zw - peer_major(local) * peer_light.projection.xy;
    return textureSampleCompareLevel(peer_map, peer_sampler, local, clip.x / clip.y);
}
