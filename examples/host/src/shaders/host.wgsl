// A plain forward renderer's shaders. `shadows_clip_position` comes from the library's
// `wgsl::POSITION`: depths are then bit-equal in every pass, the shadow volumes' included.

struct HostLight {
    place: vec4f, // homogeneous
    cone: vec4f, // unit direction, cosine of the half angle
    color: vec4f,
    range: f32,
    intensity: f32,
    number: u32,
}

struct HostFrame {
    clip_from_world: mat4x4f,
    world_from_clip: mat4x4f,
    eye: vec4f,
    ambient: vec4f, // colour; the part of what is seen that the air swallows in a metre
    horizon: vec4f,
    zenith: vec4f,
    light: HostLight,
}

struct HostObject {
    world_from_object: mat4x4f,
    normal_from_object: mat3x3f,
    albedo: vec4f,
    glow: vec4f, // colour; 1 if it casts
}

@group(0) @binding(0) var<uniform> host_frame: HostFrame;
@group(0) @binding(1) var<uniform> host_object: HostObject;

struct HostVaryings {
    @invariant @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
}

// The same without `@invariant`, which GLSL ES has for outputs alone.
struct HostFragment {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
}

// Whether a vertex is multiplied by one matrix, not by two.
override host_premultiplied: bool = false;

@vertex
fn host_vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> HostVaryings {
    return host_placed(position, normal);
}

fn host_placed(position: vec3f, normal: vec3f) -> HostVaryings {
    var out: HostVaryings;
    out.clip = shadows_clip_position(
        host_frame.clip_from_world,
        host_object.world_from_object,
        position,
    );
    if host_premultiplied {
        let clip_from_object = host_frame.clip_from_world * host_object.world_from_object;
        out.clip = clip_from_object * vec4f(position, 1.0);
    }
    out.world = (host_object.world_from_object * vec4f(position, 1.0)).xyz;
    out.normal = host_object.normal_from_object * normal;
    return out;
}

// The triangle's own normal, toward the viewer: an open mesh shows both its sides.
fn host_flat_normal(world: vec3f) -> vec3f {
    let normal = cross(dpdx(world), dpdy(world));
    return select(-normal, normal, dot(normal, host_frame.eye.xyz - world) > 0.0);
}

// The surface's own normal, smoothed over the mesh, toward the viewer.
fn host_normal(in: HostFragment, flat_normal: vec3f) -> vec3f {
    return normalize(select(-in.normal, in.normal, dot(in.normal, flat_normal) > 0.0));
}

// What a shadow may be asked by.
struct HostReceiver {
    world: vec3f,
    flat_normal: vec3f,
    normal: vec3f,
    pixel: vec2f,
    light: u32, // its place among the lights
}

fn host_receiver(in: HostFragment) -> HostReceiver {
    let flat_normal = host_flat_normal(in.world);
    let normal = host_normal(in, flat_normal);
    return HostReceiver(in.world, flat_normal, normal, in.clip.xy, host_frame.light.number);
}

// How much of what is seen comes through the air: Beer's law.
fn host_clear_air(world: vec3f) -> f32 {
    return exp(-host_frame.ambient.w * distance(world, host_frame.eye.xyz));
}

@fragment
fn host_ambient(in: HostFragment) -> @location(0) vec4f {
    return host_ambient_color(in);
}

fn host_ambient_color(in: HostFragment) -> vec4f {
    let normal = host_normal(in, host_flat_normal(in.world));
    // More light from above than from below, so that what lies in shadow keeps its form.
    let sky = 0.65 + 0.35 * normal.y;
    let own = host_object.albedo.rgb * host_frame.ambient.rgb * sky + host_object.glow.rgb;
    return vec4f(mix(host_frame.horizon.rgb, own, host_clear_air(in.world)), 1.0);
}

// Whether light ends where the smoothed normal turns away, not already where the triangle does.
override host_smooth: bool = false;

struct HostLit {
    @location(0) shaded: vec4f,
    @location(1) visibility: f32,
}

// Diffuse light: zero at the range with no step there (Karis, "Real Shading in Unreal Engine 4",
// 2013), and bounded by 1 however near the light is.
fn host_shade(in: HostFragment, visibility: f32) -> HostLit {
    let flat_normal = host_flat_normal(in.world);
    let normal = host_normal(in, flat_normal);
    let toward_light = host_frame.light.place.xyz - host_frame.light.place.w * in.world;
    let squared = dot(toward_light, toward_light);
    let ratio = squared / (host_frame.light.range * host_frame.light.range);
    let window = saturate(1.0 - ratio * ratio);
    let along = -dot(host_frame.light.cone.xyz, toward_light) * inverseSqrt(squared);
    let near_falloff = select(0.0, window * window / squared, along >= host_frame.light.cone.w);
    // No branch on what a uniform buffer says: Mesa's lavapipe would compile the shader anew for its
    // values at each draw.
    let falloff = select(1.0, near_falloff, host_frame.light.place.w != 0.0);
    let cosine = saturate(dot(normal, toward_light) * inverseSqrt(squared));
    let facing = select(0.0, 1.0, host_smooth || dot(flat_normal, toward_light) > 0.0);
    let light = 1.0 - exp(-host_frame.light.intensity * falloff * cosine * facing);
    let diffuse = host_object.albedo.rgb * (1.0 - host_frame.ambient.rgb) * light;
    let seen = diffuse * host_frame.light.color.rgb * host_clear_air(in.world);
    return HostLit(vec4f(seen * visibility, 0.0), visibility);
}
