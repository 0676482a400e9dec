// Interleaved gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced
// Warfare", SIGGRAPH 2014), as the cosine and sine of a turn: once a pixel, none in a tap loop.
fn shadows_cube_turn(pixel: vec2f, frame_shift: f32) -> vec2f {
    let at = floor(pixel) + frame_shift;
    let noise = fract(52.9829189 * fract(dot(at, vec2f(0.06711056, 0.00583715))));
    let angle = 6.2831853 * noise;
    return vec2f(cos(angle), sin(angle));
}

// The disk turned, rather than each of its offsets. `stretched` is how much longer it is along than
// across: the pattern turns within it, the disk keeps its outline.
fn shadows_cube_turned(disk: ShadowsCubeDisk, turn: vec2f) -> ShadowsCubeDisk {
    return ShadowsCubeDisk(
        turn.x * disk.across + turn.y * disk.along,
        turn.x * disk.along - turn.y * disk.across,
    );
}
