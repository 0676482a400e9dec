// Depth that is not 0 at infinity is a difference, z = d + b / w with that d, and rounds as the larger of
// the two does, however small it comes out: by the near plane in standard depth, by the far one in finite
// reversed. The host's surfaces are clipped there, volumes are not, and their common points come to
// differ by some units of d. The pipelines' depth bias, which floats take in units of z, may be less.

// How many of those units faces are set back from the viewer, beside the depth bias.
override depth_steps: f32 = 0.0;

fn set_back(clip: vec4f) -> vec4f {
    return vec4f(clip.xy, clip.z + depth_steps * camera.depth_step * clip.w, clip.w);
}
