// Where the corners of a shadow volume lie. Faces that meet compute the same position from the same
// numbers, however they came by them.

struct Caster {
    world_from_object: mat4x4f,
    // The plane of far points; xyz 0: at infinity. Point light: its product xyz with what lies
    // between the light and a point is 1. Directional light: xyz . p = w.
    far_plane: vec4f,
    // A point of that plane, or at infinity, homogeneous: where the fan's triangles meet.
    apex: vec4f,
    // In words of 4 bytes.
    position_stride: u32,
    position_offset: u32,
    // The first of the mesh's edges.
    edge_base: u32,
    side_vertices: u32,
    // As `Instance` in volume_batch.wgsl has them.
    object_light: vec4f,
    object_light_rest: vec3f,
    both_sides: u32,
    // A point of the mesh's box as near to the light as any, in the mesh's own space, and from the
    // light to it in world space.
    anchor: vec3f,
    // See `settled` in volume_light_side.wgsl.
    zero: u32,
    anchor_from_light: vec3f,
}

struct Camera {
    clip_from_world: mat4x4f,
    // See volume_depth_steps.wgsl.
    depth_step: f32,
}

struct Light {
    // World space, homogeneous.
    homogeneous: vec4f,
}

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<uniform> light: Light;

fn near_point(position: vec3f) -> vec4f {
    let clip = shadows_clip_position(camera.clip_from_world, caster.world_from_object, position);
    return set_back(clip);
}

// From the light to a vertex, in world space. What is far from both is taken off where it is known
// beyond f32, on the CPU: of a light at the caster's surface, little would be left in world space, and
// nothing of its side. Whatever the order of these sums, they round by no more than their own length
// (and the mesh's) allows.
fn from_light(position: vec3f) -> vec3f {
    let across_mesh = caster.world_from_object * vec4f(position - caster.anchor, 0.0);
    let from_point = across_mesh.xyz + caster.anchor_from_light;
    // Not a branch: Mesa's lavapipe compiles a shader anew at each draw for what a uniform buffer says,
    // if that decides a branch.
    return select(from_point, -light.homogeneous.xyz, light.homogeneous.w == 0.0);
}

// The point behind a vertex, seen from the light, in the far plane or at infinity. A vertex at the
// very place of the light has no such direction: it stays where it is, the same for every face that
// meets there, so that the surface is still closed and no vertex is (0, 0, 0, 0).
fn far_point(position: vec3f) -> vec4f {
    let direction = from_light(position);
    if all(direction == vec3f(0.0)) {
        return near_point(position);
    }
    let w = dot(caster.far_plane.xyz, direction);
    let world = (caster.world_from_object * vec4f(position, 1.0)).xyz;
    let to_plane = caster.far_plane.w - dot(caster.far_plane.xyz, world);
    let along_rays = to_plane * direction + w * world;
    let at_infinity = direction + w * light.homogeneous.xyz;
    let parallel = (light.homogeneous.w == 0.0) & (w != 0.0);
    return far_clip_position(vec4f(select(at_infinity, along_rays, parallel), w));
}

fn far_clip_position(point: vec4f) -> vec4f {
    let clip = camera.clip_from_world * point;
    return set_back(select(clip, somewhere_far(clip), clip.w == 0.0));
}

// Infinitely far away to the side, 2^30 widths of the picture are far enough: f32 tells no line to there
// from a parallel one.
fn parallel_far(clip: vec4f) -> vec4f {
    return vec4f(clip.xyz, largest(clip.xyz) * 0x1p-30f);
}

fn largest(v: vec3f) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

// A side runs b a a', b a' b' for an edge from a to b, where a' and b' are far; for a
// directional light a' = b' and one triangle is left.
fn side_corner_is_second(corner: u32) -> bool {
    return ((0x29u >> corner) & 1u) == 1u;
}

fn side_corner_is_far(corner: u32) -> bool {
    return ((0x34u >> corner) & 1u) == 1u;
}

// The dark cap as a fan: a triangle apex b' a' for each side, so that it runs back through a' b'.
fn fan_corner_is_second(corner: u32) -> bool {
    return corner == 1u;
}

fn fan_apex() -> vec4f {
    return far_clip_position(caster.apex);
}

@fragment
fn shadows_volume_nothing() {}
