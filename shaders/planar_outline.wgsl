// The polygon within which a plane receives shadows, marked in the stencil where the host's depth is the plane's.

struct ShadowsPlanarUniform {
    // Columns: what x, y and 1 of a point of the plane come to in clip space.
    clip_from_plane: mat3x4f,
}

@group(0) @binding(0) var<uniform> planar: ShadowsPlanarUniform;

// By how much depth is moved: in units of depth's own last place, and of the last place of depth 1.
override relative_step: f32 = 0.0;
override absolute_step: f32 = 0.0;

@vertex
fn outline(@location(0) place: vec2f) -> @builtin(position) vec4f {
    let clip = planar.clip_from_plane * vec3f(place, 1.0);
    let z = clip.z + relative_step * clip.z + absolute_step * clip.w;
    return vec4f(clip.xy, z, clip.w);
}

// A triangle over the whole screen, to take back what was marked.
@vertex
fn screen(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(f32(vertex & 1u) * 4.0 - 1.0, f32(vertex >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn untouched() {}
