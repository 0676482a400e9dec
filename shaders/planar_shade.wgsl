// After planar_caster.wgsl: what the projections leave in the host's picture. The stencil keeps each sample from being
// marked twice.

// Casters that are wholly between plane and light, where only the stencil is marked.
@fragment
fn untouched() {}

// Casters that may reach behind the plane, or as high as the light.
@fragment
fn untouched_cut(in: PlanarCaster) {
    if casts_nothing(in.shadow) {
        discard;
    }
}

// Whether the light does not reach the place of the shadow: there is none of it to be taken away.
fn is_beyond(shadow: vec4f) -> bool {
    let from_light = planar.place.w * (vec3f(shadow.xy / shadow.z, 0.0) - planar.place.xyz);
    let squared = dot(from_light, from_light);
    return squared > 1.0 || dot(from_light, planar.cone.xyz) < planar.cone.w * sqrt(squared);
}

@fragment
fn shade(in: PlanarCaster) -> @location(0) vec4f {
    if casts_nothing(in.shadow) || is_beyond(in.shadow) {
        discard;
    }
    return planar.shade;
}
