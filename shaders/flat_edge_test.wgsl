// The map's edge where samplers have no border: texels beyond it are told by their place.
fn shadows_flat_gathers(size: f32, first: vec2f, last: vec2f) -> bool {
    return all(first >= vec2f(1.0)) && all(last <= vec2f(size - 1.0));
}

fn shadows_flat_inside(size: f32, texel: vec2f) -> bool {
    return all(texel >= vec2f(0.0)) && all(texel < vec2f(size));
}
