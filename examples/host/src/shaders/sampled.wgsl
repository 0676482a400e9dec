// The lit pass that asks a shadow map.
@fragment
fn host_lit(in: HostFragment) -> HostLit {
    return host_light(in);
}

fn host_light(in: HostFragment) -> HostLit {
    return host_shade(in, host_visibility(host_receiver(in)));
}
