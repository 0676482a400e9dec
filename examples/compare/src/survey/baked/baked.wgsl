// What a light map says of each pixel.

@group(0) @binding(0) var<uniform> baked_clip_from_world: mat4x4f;
@group(0) @binding(1) var<uniform> baked_world_from_object: mat4x4f;
@group(0) @binding(2) var baked_map: texture_2d<f32>;
@group(0) @binding(3) var baked_linear: sampler;

struct BakedVaryings {
    @invariant @builtin(position) clip: vec4f,
    @location(0) place: vec2f,
}

@vertex
fn baked_vertex(@location(0) position: vec3f, @location(1) place: vec2f) -> BakedVaryings {
    let clip = shadows_clip_position(baked_clip_from_world, baked_world_from_object, position);
    return BakedVaryings(clip, place);
}

@fragment
fn baked_fragment(@location(0) place: vec2f) -> @location(0) f32 {
    return textureSampleLevel(baked_map, baked_linear, place, 0.0).r;
}
