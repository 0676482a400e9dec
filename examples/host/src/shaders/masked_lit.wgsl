@fragment
fn host_masked_lit(in: HostMaskedFragment) -> HostLit {
    // The shadow first: it may need derivatives.
    let lit = host_light(host_unmasked(in));
    if !host_is_leaf(in.mask) {
        discard;
    }
    return lit;
}
