// The lit pass where the stencil test decides, or nothing does: what is drawn is lit.
@fragment
fn host_lit(in: HostFragment) -> HostLit {
    return host_light(in);
}

fn host_light(in: HostFragment) -> HostLit {
    return host_shade(in, 1.0);
}
