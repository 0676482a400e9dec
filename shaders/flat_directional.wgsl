// A directional light's map. One of another light is dark.
fn shadows_flat_spot(light: ShadowsFlatLight) -> bool {
    return false;
}

fn shadows_flat_served(light: ShadowsFlatLight) -> bool {
    return light.perspective <= 0.5;
}
