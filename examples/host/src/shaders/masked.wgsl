// What leaves are cut out of: the same passes, for meshes with a place in the mask at each vertex.
struct HostMaskedVaryings {
    @invariant @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) mask: vec2f,
}

struct HostMaskedFragment {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) mask: vec2f,
}

@vertex
fn host_masked_vertex(
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) mask: vec2f,
) -> HostMaskedVaryings {
    let own = host_placed(position, normal);
    return HostMaskedVaryings(own.clip, own.world, own.normal, mask);
}

fn host_unmasked(in: HostMaskedFragment) -> HostFragment {
    return HostFragment(in.clip, in.world, in.normal);
}

@fragment
fn host_masked_ambient(in: HostMaskedFragment) -> @location(0) vec4f {
    let color = host_ambient_color(host_unmasked(in));
    if !host_is_leaf(in.mask) {
        discard;
    }
    return color;
}
