// Where the vertices of casters are: by rows of ours, after a transform of the host's where its buffer has them.

// Rows of the affine map from the mesh to where it is drawn. The host multiplies them in f64, so a scene far from
// the origin loses nothing here.
struct Instance {
    @location(1) x: vec4f,
    @location(2) y: vec4f,
    @location(3) z: vec4f,
}

fn by_instance(position: vec3f, instance: Instance) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(instance.x, p), dot(instance.y, p), dot(instance.z, p));
}

// A transform of the host's, from its own buffer: the columns of a 4x4 matrix, of which the last row is not
// read, or the rows of a 3x4 one.
struct HostColumns {
    @location(4) x: vec4f,
    @location(5) y: vec4f,
    @location(6) z: vec4f,
    @location(7) w: vec4f,
}

struct HostRows {
    @location(4) x: vec4f,
    @location(5) y: vec4f,
    @location(6) z: vec4f,
}

fn by_columns(position: vec3f, host: HostColumns) -> vec3f {
    let p = position;
    return host.x.xyz * p.x + host.y.xyz * p.y + host.z.xyz * p.z + host.w.xyz;
}

fn by_rows(position: vec3f, host: HostRows) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(host.x, p), dot(host.y, p), dot(host.z, p));
}
