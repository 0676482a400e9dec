// Depth that is not 0 at infinity is a difference, z = d + b / w with that d, and rounds as the larger of
// the two does, however small it comes out: by the near plane in standard depth, by the far one in finite
// reversed. The host's surfaces are clipped there, volumes are not, and their common points come to
// differ by some units of d. The pipelines' depth bias, which floats take in units of z, may be less.

// How many of those units faces are set back from the viewer, beside the depth bias.
override depth_steps: f32 = 0.0;

fn set_back(clip: vec4f) -> vec4f {
    return vec4f(clip.xy, clip.z + depth_steps * camera.depth_step * clip.w, clip.w);
}

// An orthographic view takes all that is infinitely far away to w = 0, and of faces with such corners
// NVIDIA's GPUs draw too little: up to 90 % of a picture was wrong. So a corner lies somewhere on its ray.
// Faces that pass around the picture are clipped in f32, and their remainders end beside its borders by
// 2^-24 of the corners' distance: of caps at 2^30 widths of the picture nothing was left. A point light's
// rays go on for 2^12 widths. That is a quarter of a pixel where there are 2048 of them, and far enough
// for a cap of triangles that the light is not nearer to than 2^-11 of their size. Of a light that is n
// widths away, more than 1, both grow with the root of n. A directional light's rays meet in one corner:
// such faces lose nothing.
fn somewhere_far(clip: vec4f) -> vec4f {
    let start = camera.clip_from_world * light.homogeneous;
    let share = largest(clip.xyz) * inverseSqrt(max(largest(start.xyz), start.w) * start.w);
    let w = transpose(camera.clip_from_world)[3];
    let on_ray = (light.homogeneous.w != 0.0) & all(w.xyz == vec3f(0.0));
    return select(parallel_far(clip), clip + share * 0x1p-12f * start, on_ray);
}
