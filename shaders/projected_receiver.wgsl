// What of a light comes to a receiver, of a texture that casters were drawn into.

// What receivers know of a shadow.
struct ShadowsProjected {
    // World space: of the light, or of a point between the casters of a directional one.
    position: vec3f,
    // 0 none (all is lit), 1 rays from a point, 2 parallel rays.
    kind: u32,
    // Axes of the tile in world space, of length 1.
    forward: vec3f,
    // Along `forward` from `position`: where the nearest caster begins. Above 0 for rays from a point.
    near: f32,
    right: vec3f,
    // Along a side of the tile.
    texels: f32,
    down: vec3f,
    // Texels across 1 in the world (parallel rays), at distance 1 (rays from a point).
    scale: f32,
    // Of the tile, from 0 to 1 across the texture.
    corner: vec2f,
    // One over the texels along a side of the texture.
    step: f32,
    // The mip level on which the tile is one texel.
    levels: f32,
    layer: i32,
}

// 0 to 1 of red, green and blue light. `x` and `y`: how the receiver's position changes to the next pixel on the
// right and below, as dpdx and dpdy say, which this does not ask so that it may be called in any branch; 0 reads
// the finest level.
fn shadows_projected_transmittance(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    shadow: ShadowsProjected,
    position: vec3f,
    x: vec3f,
    y: vec3f,
) -> vec3f {
    let axes = mat3x3f(shadow.right, shadow.down, shadow.forward);
    let local = (position - shadow.position) * axes;
    let spreads = shadow.kind == 1u;
    let away = select(1.0, max(local.z, shadow.near), spreads);
    let slope = select(vec2f(0.0), local.xy / away, spreads);
    let per = shadow.scale / away;
    let place = local.xy * per + 0.5 * shadow.texels;
    // How far it is to the next pixels, in texels.
    let right = x * axes;
    let below = y * axes;
    let across = (right.xy - slope * right.z) * per;
    let along = (below.xy - slope * below.z) * per;
    let squared = max(dot(across, across), dot(along, along));
    // No lower than the finest level, where one texel covers several pixels.
    let level = min(0.5 * log2(max(squared, 1.0)), shadow.levels);
    let finer = floor(level);
    let coarser = min(finer + 1.0, shadow.levels);
    // Beyond half a texel from the tile there is light; and before the casters, and behind the light.
    let most = 0.5 * (shadow.texels + shadows_projected_texel(coarser));
    let inside = all(abs(place - 0.5 * shadow.texels) < vec2f(most));
    let shaded = inside & (local.z >= shadow.near) & (shadow.kind != 0u);
    if shaded {
        let fine = shadows_projected_shade(map, map_sampler, shadow, place, finer);
        let coarse = shadows_projected_shade(map, map_sampler, shadow, place, coarser);
        return saturate(1.0 - mix(fine, coarse, level - finer));
    }
    return vec3f(1.0);
}

// The same of a surface with a normal, of any length: there is no shadow on what looks away from the light, which
// the light does not reach.
fn shadows_projected_transmittance_facing(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    shadow: ShadowsProjected,
    position: vec3f,
    normal: vec3f,
    x: vec3f,
    y: vec3f,
) -> vec3f {
    let ray = select(shadow.forward, position - shadow.position, shadow.kind == 1u);
    if dot(normal, ray) >= 0.0 {
        return vec3f(1.0);
    }
    return shadows_projected_transmittance(map, map_sampler, shadow, position, x, y);
}

// The side of a texel of a level, in texels of the finest one.
fn shadows_projected_texel(level: f32) -> f32 {
    return f32(1u << u32(level));
}

// What does not come through, of one level. A sampler blends texels of the tile alone, since no place is nearer
// to the tile's edge than the centres of its outermost texels; beyond those it is blended with light.
fn shadows_projected_shade(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    shadow: ShadowsProjected,
    place: vec2f,
    level: f32,
) -> vec3f {
    let texel = shadows_projected_texel(level);
    let side = shadow.texels / texel;
    let at = place / texel;
    let border = saturate(min(at, side - at) + 0.5);
    let centre = clamp(at, vec2f(0.5), vec2f(side - 0.5));
    let read = textureSampleLevel(
        map, map_sampler, shadow.corner + centre * (texel * shadow.step), shadow.layer, level
    );
    return (1.0 - read.rgb) * (border.x * border.y);
}
