// After cube_caster.wgsl: the faces of one light in one pass, a view (an array layer) each. The
// arithmetic is that of cube_caster_face.wgsl, so that both give the same bits.

// The uniforms lie where one face a pass has them, a dynamic offset's alignment apart.
struct ShadowsCubeFaceSlot {
    @size(256) face: ShadowsCubeFaceUniform,
}

@group(0) @binding(0) var<uniform> faces: array<ShadowsCubeFaceSlot, 6>;

// Whether each draw's last instance is a separator: all zero, in one point in the middle of every
// view. See `Joint` for the driver that needs it.
override separators: bool = false;

fn clip_position(view: u32, relative: vec3f, instance: Instance) -> vec4f {
    if separators && all((abs(instance.x) + abs(instance.y) + abs(instance.z)) == vec4f(0.0)) {
        return vec4f(0.0, 0.0, 0.5, 1.0);
    }
    return faces[view].face.clip_from_light * vec4f(relative, 1.0);
}

@vertex
fn vertex(
    @builtin(view_index) view: u32,
    @location(0) position: vec3f,
    instance: Instance,
) -> @builtin(position) vec4f {
    return clip_position(view, from_light(position, instance), instance);
}

@vertex
fn vertex_distance(
    @builtin(view_index) view: u32,
    @location(0) position: vec3f,
    instance: Instance,
) -> Fragment {
    let relative = from_light(position, instance);
    return Fragment(clip_position(view, relative, instance), relative);
}

// All six have the light's range.
@fragment
fn fragment_distance(in: Fragment) -> @builtin(frag_depth) f32 {
    return length(in.from_light) / faces[0].face.range;
}
