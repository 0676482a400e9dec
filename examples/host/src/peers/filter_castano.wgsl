// Bevy's default filter, `Gaussian`, which is Castano's (2013): a 5x5 tent from nine hardware comparisons,
// all with one depth.
fn peer_tap(base: vec2f, offset: vec2f, depth: f32) -> f32 {
    let uv = base + offset / peer_light.size;
    return textureSampleCompareLevel(peer_map, peer_sampler, uv, depth);
}

fn peer_filter(uv: vec2f, depth: f32) -> f32 {
    let at = uv * peer_light.size;
    let base = floor(at + 0.5);
    let s = at + 0.5 - base;
    let corner = (base - 0.5) / peer_light.size;
    let w0 = 4.0 - 3.0 * s;
    let w1 = vec2f(7.0);
    let w2 = 1.0 + 3.0 * s;
    let o0 = (3.0 - 2.0 * s) / w0 - 2.0;
    let o1 = (3.0 + s) / w1;
    let o2 = s / w2 + 2.0;
    var lit = w0.x * w0.y * peer_tap(corner, vec2f(o0.x, o0.y), depth);
    lit += w1.x * w0.y * peer_tap(corner, vec2f(o1.x, o0.y), depth);
    lit += w2.x * w0.y * peer_tap(corner, vec2f(o2.x, o0.y), depth);
    lit += w0.x * w1.y * peer_tap(corner, vec2f(o0.x, o1.y), depth);
    lit += w1.x * w1.y * peer_tap(corner, vec2f(o1.x, o1.y), depth);
    lit += w2.x * w1.y * peer_tap(corner, vec2f(o2.x, o1.y), depth);
    lit += w0.x * w2.y * peer_tap(corner, vec2f(o0.x, o2.y), depth);
    lit += w1.x * w2.y * peer_tap(corner, vec2f(o1.x, o2.y), depth);
    lit += w2.x * w2.y * peer_tap(corner, vec2f(o2.x, o2.y), depth);
    return lit / 144.0;
}
