// What a count goes back to between two lights; the place of the target is the pass's.

@fragment
fn shadows_volume_reset() -> @location(0) f32 {
    return 0.0;
}

@fragment
fn shadows_volume_untouched() {}
