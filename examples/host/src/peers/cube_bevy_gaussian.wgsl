// Bevy 0.20.1's point light with its default filter, `Gaussian` (bevy_pbr: shadow_sampling.wesl,
// sample_shadow_cubemap_gaussian): the same receiver as with `Hardware2x2`, eight comparisons around it in
// the plane across the ray, weighted by a Gaussian, all with one depth. They are spread by an angle, not
// by texels.
@group(1) @binding(0) var peer_map: texture_depth_cube;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

const PEER_SPREAD = 0.003;

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

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let to_light = peer_light.position - position;
    let distance = peer_major(to_light);
    let across = peer_light.normal_bias * distance;
    let moved = position + across * normal + peer_light.bias * normalize(to_light);
    let local = moved - peer_light.position;
    let clip = peer_light.projection.zw - peer_major(local) * peer_light.projection.xy;
    let depth = clip.x / clip.y;
    let axes = peer_axes(normalize(local));
    let scale = PEER_SPREAD * distance;
    let x = scale * axes[0];
    let y = scale * axes[1];
    var lit = 0.0;
    for (var i = 0; i < 8; i++) {
        let tap = PEER_TAPS[i];
        let at = local + tap.x * x + tap.y * y;
        lit += tap.z * textureSampleCompareLevel(peer_map, peer_sampler, at, depth);
    }
    return lit;
}
