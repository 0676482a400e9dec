// Depth of casters on one face of a cube map, or on a flat map: what all back ends share.

struct ShadowsCubeFaceUniform {
    clip_from_light: mat4x4f,
    range: f32,
    // Of the map's side, where that is 2 wide.
    texel: f32,
}

// Rows of the affine map from the mesh to positions relative to the light. The host multiplies
// them in f64, so a scene far from the origin loses nothing here.
struct Instance {
    @location(1) x: vec4f,
    @location(2) y: vec4f,
    @location(3) z: vec4f,
}

fn from_light(position: vec3f, instance: Instance) -> vec3f {
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

@group(0) @binding(0) var<uniform> face: ShadowsCubeFaceUniform;

fn clip_position(position: vec3f, instance: Instance) -> vec4f {
    return face.clip_from_light * vec4f(from_light(position, instance), 1.0);
}

// Distance from the light as a fraction of its range (Gerasimov 2004), on the ray through the texel's centre.
// A position that is interpolated lies beside that ray by as much as the vertices were snapped.
@fragment
fn fragment_distance(@builtin(position) pixel: vec4f) -> @builtin(frag_depth) f32 {
    let ray = vec3f(pixel.xy * face.texel - 1.0, 1.0);
    return length(ray) / (pixel.w * face.range);
}
