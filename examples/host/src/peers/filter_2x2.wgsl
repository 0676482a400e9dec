// Bevy's `Hardware2x2`: one hardware comparison.
fn peer_filter(uv: vec2f, depth: f32) -> f32 {
    return textureSampleCompareLevel(peer_map, peer_sampler, uv, depth);
}
