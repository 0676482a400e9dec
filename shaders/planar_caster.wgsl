// After caster_places.wgsl: casters projected onto a plane from a light, a point or a direction (Blinn, "Me and My
// (Fake) Shadow", 1988). Rows of instances lead to the plane's own frame: x and y along it, z above it, counted
// from a point of it near the casters.

struct ShadowsPlanarUniform {
    // Columns: what x, y and 1 of a point of the plane come to in clip space.
    clip_from_plane: mat3x4f,
    // By how much a unit of height moves a shadow along x and y, and what it takes from its w: 1 over the
    // light's own height, 0 for a directional light.
    slope: vec4f,
    // What is left of a colour in shadow.
    shade: vec4f,
    // The light's place in the plane's frame, and 1 over its range, 0 where it has none.
    place: vec4f,
    // Of a spot: its direction in the plane's frame, and the cosine of its half angle. Others shine
    // everywhere: 0, and -1.
    cone: vec4f,
}

@group(0) @binding(0) var<uniform> planar: ShadowsPlanarUniform;

struct PlanarCaster {
    @builtin(position) clip: vec4f,
    // The shadow in the plane's frame, homogeneous, and how high above the plane what casts it is.
    @location(0) shadow: vec4f,
}

fn projected(position: vec3f) -> PlanarCaster {
    let height = position.z;
    let shadow = vec3f(position.xy - height * planar.slope.xy, 1.0 - height * planar.slope.z);
    return PlanarCaster(planar.clip_from_plane * shadow, vec4f(shadow, height));
}

@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> PlanarCaster {
    return projected(by_instance(position, instance));
}

// One of many that the host places in its own buffer, and then as a whole.
@vertex
fn vertex_columns(
    @location(0) position: vec3f,
    instance: Instance,
    host: HostColumns,
) -> PlanarCaster {
    return projected(by_instance(by_columns(position, host), instance));
}

@vertex
fn vertex_rows(@location(0) position: vec3f, instance: Instance, host: HostRows) -> PlanarCaster {
    return projected(by_instance(by_rows(position, host), instance));
}

// Whether it is behind the plane, or no nearer to it than the light: what is there casts nothing on the plane,
// but its projection is there, too.
fn casts_nothing(shadow: vec4f) -> bool {
    return shadow.w < 0.0 || shadow.z <= 0.0;
}
