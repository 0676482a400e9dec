// After planar_caster.wgsl: what the projections from one place of a light with a size add to the count of those
// places that a texel does not see. The stencil keeps each texel from being counted twice.

// One of 255 steps of 8 bits.
const one_place = vec4f(1.0 / 255.0);

// Casters that are wholly between plane and light.
@fragment
fn count() -> @location(0) vec4f {
    return one_place;
}

// Casters that may reach behind the plane, or as high as the light.
@fragment
fn count_cut(in: PlanarCaster) -> @location(0) vec4f {
    if casts_nothing(in.shadow) {
        discard;
    }
    return one_place;
}
