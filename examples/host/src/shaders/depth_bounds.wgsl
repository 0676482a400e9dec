// The least and the greatest depth of a picture. Of floats that are not negative, those with the greater bits
// are the greater ones. Not a depth texture in name, which naga cannot load from in GLSL.
@group(0) @binding(0) var host_depth: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> host_found: array<atomic<u32>, 2>;

// What is stored where nothing was drawn: 0 in reverse conventions.
override host_cleared: f32 = 0.0;

@compute @workgroup_size(8, 8)
fn host_depth_bounds(@builtin(global_invocation_id) at: vec3u) {
    if any(at.xy >= textureDimensions(host_depth)) {
        return;
    }
    let depth = textureLoad(host_depth, at.xy, 0).x;
    if depth == host_cleared {
        return;
    }
    atomicMin(&host_found[0], bitcast<u32>(depth));
    atomicMax(&host_found[1], bitcast<u32>(depth));
}
