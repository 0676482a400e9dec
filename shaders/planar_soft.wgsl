// Reads a PlanarSoftShadow.

struct ShadowsPlanarSoft {
    // A corner of the rectangle in world space, and 255 over the number of the light's places.
    corner: vec4f,
    // By which the offset from the corner becomes texture coordinates, and the height above the plane a part of
    // the width of a texel.
    across: vec4f,
    down: vec4f,
    up: vec4f,
}

// How much of the light a point of the rectangle sees: 0 nothing, 1 all of it. Beside the rectangle, and more than
// a texel's width above or below its plane: 1. `linear`: a sampler that filters.
fn shadows_planar_soft(
    counts: texture_2d<f32>,
    linear: sampler,
    rectangle: ShadowsPlanarSoft,
    world: vec3f,
) -> f32 {
    let offset = world - rectangle.corner.xyz;
    let place = vec2f(dot(rectangle.across.xyz, offset), dot(rectangle.down.xyz, offset));
    let height = dot(rectangle.up.xyz, offset);
    let hidden = textureSampleLevel(counts, linear, place, 0.0).r * rectangle.corner.w;
    let receives = all(place >= vec2f(0.0)) && all(place <= vec2f(1.0)) && abs(height) <= 1.0;
    return select(1.0, 1.0 - hidden, receives);
}
