// three.js r187's point light with `PCFShadowMap`: five comparisons on a Vogel disk across the ray,
// turned by interleaved gradient noise, each with the receiver's depth along that tap's own major
// axis; a constant bias in depth and an offset along the shading normal.
@group(1) @binding(0) var peer_map: texture_depth_cube;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

const PEER_BIAS = 0.0005;
const PEER_NORMAL_BIAS = 0.02;

fn peer_tap(local: vec3f) -> f32 {
    let a = abs(local);
    let depth = peer_light.near / max(a.x, max(a.y, a.z)) + PEER_BIAS * peer_light.near;
    return textureSampleCompareLevel(peer_map, peer_sampler, local, depth);
}

fn peer_disk(i: u32, turn: f32) -> vec2f {
    let angle = f32(i) * 2.399963229728653 + turn;
    return sqrt((f32(i) + 0.5) / 5.0) * vec2f(cos(angle), sin(angle));
}

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let local = position + PEER_NORMAL_BIAS * normal - peer_light.position;
    let distance = length(local);
    if distance > peer_light.range {
        return 1.0;
    }
    let ray = local / distance;
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(ray.y) > 0.99);
    let across = normalize(cross(up, ray));
    let along = cross(ray, across);
    let turn = 6.2831853 * fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
    let radius = distance / peer_light.size;
    var lit = 0.0;
    for (var i = 0u; i < 5u; i++) {
        let offset = radius * peer_disk(i, turn);
        lit += peer_tap(local + offset.x * across + offset.y * along);
    }
    return lit / 5.0;
}
