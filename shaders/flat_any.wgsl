// A tile of any kind of light but a point light: what is so of one kind alone is selected, not branched to. Mesa's
// lavapipe compiles a shader anew at each draw for what a uniform buffer says, if that decides a branch, even one
// as && makes.
fn shadows_flat_spot(light: ShadowsLight) -> bool {
    return shadows_kind(light) == 2u;
}

fn shadows_flat_served(light: ShadowsLight) -> bool {
    return shadows_kind(light) >= 2u;
}
