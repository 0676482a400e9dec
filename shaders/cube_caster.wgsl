// Depth of casters on one face of a cube map.

struct ShadowsCubeRange {
    near: f32,
    range: f32,
}

@group(0) @binding(0) var<uniform> light: ShadowsCubeRange;

// Rows of the affine map from the mesh to positions relative to the light, in the face's own frame.
// The host multiplies them in f64, so a scene far from the origin loses nothing here; and since the
// frames differ only in the order and the signs of their axes, there is no matrix left to apply.
struct Instance {
    @location(1) right: vec4f,
    @location(2) up: vec4f,
    @location(3) forward: vec4f,
}

fn from_light(position: vec3f, instance: Instance) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(instance.right, p), dot(instance.up, p), dot(instance.forward, p));
}

// 90 degrees, infinite reverse-Z: w is the distance along the major axis, depth is near / w.
fn clip(relative: vec3f) -> vec4f {
    return vec4f(relative.xy, light.near, relative.z);
}

@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> @builtin(position) vec4f {
    return clip(from_light(position, instance));
}

struct Fragment {
    @builtin(position) clip: vec4f,
    @location(0) from_light: vec3f,
}

@vertex
fn vertex_distance(@location(0) position: vec3f, instance: Instance) -> Fragment {
    let relative = from_light(position, instance);
    return Fragment(clip(relative), relative);
}

// Distance from the light as a fraction of its range (Gerasimov 2004).
@fragment
fn fragment_distance(in: Fragment) -> @builtin(frag_depth) f32 {
    return length(in.from_light) / light.range;
}
