// Bevy 0.20's point light with the `Gaussian` filter: the same receiver, eight comparisons around it
// in the plane across the ray, weighted by a Gaussian, all with one depth.
@group(1) @binding(0) var peer_map: texture_depth_cube;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

// x, y and weight: the eight samples of Direct3D's standard pattern.
const PEER_TAPS = array<vec3f, 8>(
    vec3f(0.125, -0.375, 0.157112), vec3f(-0.125, 0.375, 0.157112),
    vec3f(0.625, 0.125, 0.138651), vec3f(-0.375, -0.625, 0.130251),
    vec3f(-0.625, 0.625, 0.114946), vec3f(-0.875, -0.125, 0.114946),
    vec3f(0.375, 0.875, 0.107982), vec3f(0.875, -0.875, 0.079001),
);

fn peer_major(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

fn peer_tap(local: vec3f, depth: f32) -> f32 {
    return textureSampleCompareLevel(peer_map, peer_sampler, local, depth);
}

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let to_light = peer_light.position - position;
    let texel = 0.6 * 1.4142135 * 2.0 / peer_light.size * peer_major(to_light);
    let moved = position + texel * normal + 0.08 * normalize(to_light);
    let local = moved - peer_light.position;
    let major = peer_major(local);
    let depth = peer_light.near / major;
    // Any two axes across the ray.
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(local.y) > 0.9 * major);
    let scale = 2.0 / peer_light.size * major;
    let across = scale * normalize(cross(up, local));
    let along = scale * normalize(cross(local, across));
    var lit = 0.0;
    for (var i = 0; i < 8; i++) {
        let tap = PEER_TAPS[i];
        lit += tap.z * peer_tap(local + tap.x * across + tap.y * along, depth);
    }
    return lit;
}
