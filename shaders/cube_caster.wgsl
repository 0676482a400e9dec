// Depth of casters on one face of a cube map. Depth is near / (distance along the major axis).

@group(0) @binding(0) var<uniform> clip_from_light: mat4x4f;

// Rows of the affine map from the mesh to positions relative to the light. The host multiplies
// them in f64, so a scene far from the origin loses nothing here.
struct Instance {
    @location(1) x: vec4f,
    @location(2) y: vec4f,
    @location(3) z: vec4f,
}

@vertex
fn vertex(@location(0) position: vec3f, instance: Instance) -> @builtin(position) vec4f {
    let p = vec4f(position, 1.0);
    let relative = vec3f(dot(instance.x, p), dot(instance.y, p), dot(instance.z, p));
    return clip_from_light * vec4f(relative, 1.0);
}
