// A map of any kind of light: what is so of one kind alone is selected, not branched to. Mesa's lavapipe
// compiles a shader anew at each draw for what a uniform buffer says, if that decides a branch, even one
// as && makes.
fn shadows_flat_spot(light: ShadowsFlatLight) -> bool {
    return light.perspective > 0.5;
}

fn shadows_flat_served(light: ShadowsFlatLight) -> bool {
    return true;
}
