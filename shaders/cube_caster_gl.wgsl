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

fn drawn(clip: vec4f) -> Drawn {
    return Drawn(vec4f(clip.xy, 0.5 * clip.w, clip.w), clip.z);
}

@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> Drawn {
    return drawn(clip_position(position, instance));
}

// One of many that the host places in its own buffer, and then as a whole.
@vertex
fn vertex_columns(@location(0) position: vec3f, instance: Instance, host: HostColumns) -> Drawn {
    return drawn(clip_position(by_columns(position, host), instance));
}

@vertex
fn vertex_rows(@location(0) position: vec3f, instance: Instance, host: HostRows) -> Drawn {
    return drawn(clip_position(by_rows(position, host), instance));
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
