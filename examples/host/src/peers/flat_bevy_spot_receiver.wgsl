// Bevy 0.20.1's spot light (bevy_pbr: shadows.wesl, fetch_spot_shadow): its axes are made anew from the
// direction, of which two coordinates and a sign are stored.
@group(1) @binding(0) var peer_map: texture_depth_2d;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerSpotLight;

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let to_light = peer_light.position - position;
    let across = peer_light.direction_xz;
    var direction = vec3f(across.x, 0.0, across.y);
    direction.y = sqrt(max(0.0, 1.0 - across.x * across.x - across.y * across.y));
    if peer_light.down != 0u {
        direction.y = -direction.y;
    }
    let back = -direction;
    let distance = dot(back, to_light);
    let moved = peer_light.bias * normalize(to_light) - to_light
        + peer_light.normal_bias * distance * normal;
    let local = moved * peer_axes(back);
    let at = local.xy / (peer_light.tan_angle * -local.z);
    return peer_filter(at * vec2f(0.5, -0.5) + 0.5, peer_light.near / -local.z);
}
