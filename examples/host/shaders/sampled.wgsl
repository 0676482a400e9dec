// The lit pass that asks a shadow map.
@fragment
fn host_lit(in: HostVaryings) -> HostLit {
    return host_light(in, shadows_visibility(in.world));
}
