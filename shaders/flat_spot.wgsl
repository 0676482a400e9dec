// A spot's tile. One of another light is dark.
fn shadows_flat_spot(light: ShadowsLight) -> bool {
    return true;
}

fn shadows_flat_served(light: ShadowsLight) -> bool {
    return shadows_kind(light) == 2u;
}
