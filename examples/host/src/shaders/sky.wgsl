// The sky behind everything: a triangle over the whole picture.
struct HostSky {
    @builtin(position) clip: vec4f,
    @location(0) direction: vec3f,
}

@vertex
fn host_sky_vertex(@builtin(vertex_index) index: u32) -> HostSky {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    let near = host_frame.world_from_clip * vec4f(corner, 1.0, 1.0);
    let far = host_frame.world_from_clip * vec4f(corner, 0.5, 1.0);
    // Depth is not tested.
    return HostSky(vec4f(corner, 0.5, 1.0), far.xyz * near.w - near.xyz * far.w);
}

@fragment
fn host_sky(in: HostSky) -> @location(0) vec4f {
    let up = max(normalize(in.direction).y, 0.0);
    return vec4f(mix(host_frame.horizon.rgb, host_frame.zenith.rgb, pow(up, 0.6)), 1.0);
}
