// The tile's edge where samplers find something beyond it: texels there are told by their place.
fn shadows_flat_gathers(light: ShadowsLight, corner: vec2f, reach: f32) -> bool {
    return all(abs(corner) < vec2f(light.middle - 0.5 - reach));
}

fn shadows_flat_inside(light: ShadowsLight, texel: vec2f) -> bool {
    return all(abs(texel + 0.5) < vec2f(light.middle));
}
