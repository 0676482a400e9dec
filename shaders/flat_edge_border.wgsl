// The tile's edge where it is the texture's and samplers have a border: beyond it they find depth 0, which is
// nothing.
fn shadows_flat_gathers(light: ShadowsLight, corner: vec2f, reach: f32) -> bool {
    return true;
}

fn shadows_flat_inside(light: ShadowsLight, texel: vec2f) -> bool {
    return true;
}
