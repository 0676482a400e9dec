// Visibility of a point past all blobs. Needs `blob_visibility.wgsl`.

struct ShadowsBlobs {
    count: vec4u, // in x
    list: array<ShadowsBlob>,
}

@group(0) @binding(0) var<uniform> shadows_blob_lights: array<ShadowsBlobLight, 1>;
@group(0) @binding(1) var<storage, read> shadows_blobs: ShadowsBlobs;

// 1 lit, 0 in shadow. `light` is the light's place in the frame, `position` is in world space.
fn shadows_blob_visibility(light: u32, position: vec3f) -> f32 {
    return shadows_blob_visibility_of(light, position, 0xffffffffu);
}

// The same on the surface of the frame's caster or blob `own`, whose own shadow is left out.
fn shadows_blob_visibility_of(light: u32, position: vec3f, own: u32) -> f32 {
    let to_light = shadows_blob_to_light(shadows_blob_lights[light], position);
    let count = min(shadows_blobs.count.x, arrayLength(&shadows_blobs.list));
    var visibility = 1.0;
    for (var i = 0u; i < count; i++) {
        let blob = shadows_blobs.list[i];
        if i != own {
            let from_centre = position - shadows_blob_centre(blob);
            visibility *= shadows_blob_past(blob, shadows_blob_lights[light], from_centre, to_light);
        }
    }
    return visibility;
}
