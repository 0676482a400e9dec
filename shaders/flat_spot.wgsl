// A spot's map. One of another light is dark.
fn shadows_flat_spot(light: ShadowsFlatLight) -> bool {
    return true;
}

fn shadows_flat_served(light: ShadowsFlatLight) -> bool {
    return light.perspective >= 0.5;
}
