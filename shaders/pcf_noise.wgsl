// Interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced
// Warfare", SIGGRAPH 2014), as the cosine and sine of a turn: once a pixel, none in a tap loop.
fn shadows_cube_turn(pixel: vec2f, frame_shift: f32) -> vec2f {
    let at = floor(pixel) + frame_shift;
    let noise = fract(52.9829189 * fract(dot(at, vec2f(0.06711056, 0.00583715))));
    let angle = 6.2831853 * noise;
    return vec2f(cos(angle), sin(angle));
}

// The offset of tap `i`, turned.
// The table is a texture: a uniform array given as a parameter is copied for every pixel.
fn shadows_cube_turned(offsets: texture_3d<f32>, i: u32, turn: vec2f) -> vec2f {
    let pair = textureLoad(offsets, vec3i(0, 0, i32(i / 2u)), 0);
    let offset = select(pair.xy, pair.zw, (i & 1u) == 1u);
    return vec2f(dot(offset, vec2f(turn.x, -turn.y)), dot(offset, turn.yx));
}
