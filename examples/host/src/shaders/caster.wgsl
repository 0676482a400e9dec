// Depth of casters that only the host can draw, for shadow maps: alpha-tested leaves.
struct HostCaster {
    @builtin(position) clip: vec4f,
    @location(0) mask: vec2f,
}

@group(0) @binding(0) var<uniform> host_clip_from_world: mat4x4f;
@group(0) @binding(1) var<uniform> host_caster: mat4x4f;

@vertex
fn host_caster_vertex(@location(0) position: vec3f, @location(2) mask: vec2f) -> HostCaster {
    let world = host_caster * vec4f(position, 1.0);
    return HostCaster(host_clip_from_world * world, mask);
}

@fragment
fn host_caster_mask(in: HostCaster) {
    if !host_is_leaf(in.mask) {
        discard;
    }
}
