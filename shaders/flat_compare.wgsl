// Four texels of a tile.

// Whether the texels around all corners within `reach` of this one can be gathered.
fn shadows_flat_whole(receiver: ShadowsFlatReceiver, corner: vec2f, reach: f32) -> bool {
    return shadows_flat_gathers(receiver.light, corner, reach);
}

// Whether casters are nearer than the plane at the texels around a corner: bottom left, bottom right,
// top right, top left. Its depths are `columns` (left, right) and `rows` (top, bottom) together.
fn shadows_flat_blocked(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    receiver: ShadowsFlatReceiver,
    corner: vec2f,
    columns: vec2f,
    rows: vec2f,
) -> vec4<bool> {
    // What is farther than a directional light's range is not behind what is empty.
    let stored = shadows_flat_stored(map, map_sampler, receiver, corner);
    let depths = columns.xyyx + rows.yyxx;
    return max(depths, vec4f(0.0)) < stored;
}

// The receiver as its texels are looked at one by one: its place from what gathers need as well, which leaves a
// GPU two registers more for them.
fn shadows_flat_again(receiver: ShadowsFlatReceiver, corner: vec2f, s: vec2f) -> ShadowsFlatReceiver {
    var again = receiver;
    again.texel = corner + s - 0.5;
    return again;
}
