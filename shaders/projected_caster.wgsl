// What of its light comes through casters, into a tile that begins as light: each fragment is multiplied with
// what is there. Nothing is tested for depth, so a tile knows that there is a caster, and not where.

// Rows of the affine map from the mesh to x, y and w of the tile's clip space, which the library multiplies in
// f64; and what of red, green and blue light comes through.
struct Instance {
    @location(1) x: vec4f,
    @location(2) y: vec4f,
    @location(3) w: vec4f,
    @location(4) transmittance: vec4f,
}

struct Drawn {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) transmittance: vec4f,
}

// In the middle of clip space, whatever its depth: near and far planes clip nothing. What is behind the light is
// clipped by the sides, which meet in it.
fn drawn(position: vec3f, instance: Instance) -> Drawn {
    let p = vec4f(position, 1.0);
    let w = dot(instance.w, p);
    let clip = vec4f(dot(instance.x, p), dot(instance.y, p), 0.5 * w, w);
    return Drawn(clip, instance.transmittance);
}

@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> Drawn {
    return drawn(position, instance);
}

// One of many that the host places in its own buffer, and then as a whole: the columns of a 4x4 matrix, of
// which the last row is not read, or the rows of a 3x4 one.
struct HostColumns {
    @location(5) x: vec4f,
    @location(6) y: vec4f,
    @location(7) z: vec4f,
    @location(8) w: vec4f,
}

struct HostRows {
    @location(5) x: vec4f,
    @location(6) y: vec4f,
    @location(7) z: vec4f,
}

@vertex
fn vertex_columns(@location(0) position: vec3f, instance: Instance, host: HostColumns) -> Drawn {
    let p = position;
    return drawn(host.x.xyz * p.x + host.y.xyz * p.y + host.z.xyz * p.z + host.w.xyz, instance);
}

@vertex
fn vertex_rows(@location(0) position: vec3f, instance: Instance, host: HostRows) -> Drawn {
    let p = vec4f(position, 1.0);
    return drawn(vec3f(dot(host.x, p), dot(host.y, p), dot(host.z, p)), instance);
}

@fragment
fn fragment(in: Drawn) -> @location(0) vec4f {
    return in.transmittance;
}
