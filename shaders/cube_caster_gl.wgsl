// After cube_caster.wgsl: on wgpu's GL back end. There clip z becomes 2 z - w, which for
// reverse-Z is a small difference of large numbers: it loses depth's digits, and far triangles to GL's
// far plane. So fragments write depth, and vertices lie in the middle of clip space, where 2 z - w is 0.

// Slope-scaled bias: the rasteriser adds it to its own depths alone.
override slope_scale: f32 = 0.0;

// Whether casters before the near plane are pulled onto it, or left out.
override pulled: bool = true;

struct Drawn {
    @builtin(position) clip: vec4f,
    @location(0) z: f32,
}

fn in_the_middle(clip: vec4f) -> vec4f {
    return vec4f(clip.xy, 0.5 * clip.w, clip.w);
}

@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> Drawn {
    let clip = face.clip_from_light * vec4f(from_light(position, instance), 1.0);
    return Drawn(in_the_middle(clip), clip.z);
}

// Over w, as the rasteriser has it elsewhere: of a fragment's position, w is 1 over that of clip space.
@fragment
fn fragment_depth(in: Drawn) -> @builtin(frag_depth) f32 {
    let depth = in.z * in.clip.w;
    let slope = max(abs(dpdx(depth)), abs(dpdy(depth)));
    if !pulled && depth > 1.0 {
        discard;
    }
    return min(depth - slope_scale * slope, 1.0);
}
