// The map's edge where samplers have no border: texels beyond it are told by their place.
fn shadows_flat_gathers(size: f32, corner: vec2f, reach: f32) -> bool {
    return all(abs(corner - 0.5 * size) <= vec2f(0.5 * size - 1.0 - reach));
}

fn shadows_flat_inside(size: f32, texel: vec2f) -> bool {
    return all(abs(texel + (0.5 - 0.5 * size)) < vec2f(0.5 * size));
}
