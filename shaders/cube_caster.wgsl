// Depth of casters on one face of a cube map.

struct ShadowsCubeFaceUniform {
    clip_from_light: mat4x4f,
    range: f32,
}

@group(0) @binding(0) var<uniform> face: ShadowsCubeFaceUniform;

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

// The rasteriser's own depth: near / (distance along the major axis).
@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> @builtin(position) vec4f {
    return face.clip_from_light * vec4f(from_light(position, instance), 1.0);
}

struct Fragment {
    @builtin(position) clip: vec4f,
    @location(0) from_light: vec3f,
}

@vertex
fn vertex_distance(@location(0) position: vec3f, instance: Instance) -> Fragment {
    let relative = from_light(position, instance);
    return Fragment(face.clip_from_light * vec4f(relative, 1.0), relative);
}

// Distance from the light as a fraction of its range (Gerasimov 2004).
@fragment
fn fragment_distance(in: Fragment) -> @builtin(frag_depth) f32 {
    return length(in.from_light) / face.range;
}
