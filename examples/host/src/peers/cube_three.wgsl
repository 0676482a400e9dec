// three.js r187's point light with its default, `PCFShadowMap` (shadowmap_pars_fragment.glsl.js,
// getPointShadow): five comparisons on a Vogel disk across the ray, turned by interleaved gradient noise,
// each with the receiver's depth along that tap's own major axis. Its normal bias is added in the vertex
// shader, and is 0 where it is not set.
@group(1) @binding(0) var peer_map: texture_depth_cube;
@group(1) @binding(1) var peer_sampler: sampler_comparison;
@group(1) @binding(2) var<uniform> peer_light: PeerCubeLight;

fn peer_major(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

fn peer_disk(i: u32, turn: f32) -> vec2f {
    let angle = f32(i) * 2.399963229728653 + turn;
    return sqrt((f32(i) + 0.5) / 5.0) * vec2f(cos(angle), sin(angle));
}

fn peer_visibility(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    let local = position - peer_light.position;
    let along = peer_major(local);
    let near = peer_light.near;
    let far = peer_light.range;
    var lit = 1.0;
    if along - far <= 0.0 && along - near >= 0.0 {
        let distance = length(local);
        let ray = local / distance;
        let a = far / (far - near) + peer_light.bias;
        let b = -near * far / ((far - near) * distance);
        let toward = abs(ray);
        let helper = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), toward.x > toward.z);
        let x = normalize(cross(ray, helper));
        let y = cross(ray, x);
        let texel = peer_light.radius / peer_light.size;
        let noise = fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
        lit = 0.0;
        for (var i = 0u; i < 5u; i++) {
            let offset = peer_disk(i, 6.2831853 * noise);
            let tap = ray + texel * (offset.x * x + offset.y * y);
            let depth = a + b / peer_major(tap);
            lit += textureSampleCompareLevel(peer_map, peer_sampler, tap, depth);
        }
        lit *= 0.2;
    }
    return mix(1.0, lit, peer_light.intensity);
}
