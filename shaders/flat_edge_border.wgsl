// The map's edge where samplers have a border: beyond it they find depth 0, which is nothing.
fn shadows_flat_gathers(size: f32, corner: vec2f, reach: f32) -> bool {
    return true;
}

fn shadows_flat_inside(size: f32, texel: vec2f) -> bool {
    return true;
}
