// What a face of a shadow volume adds to a count in a colour target; the blending gives it the sign
// that z-pass or z-fail asks for.

@fragment
fn shadows_volume_count(@builtin(front_facing) front: bool) -> @location(0) f32 {
    return select(-1.0, 1.0, front);
}
