// What receivers know of a light, as the map writes it.

struct ShadowsFlatLight {
    // Origin of the frame: the light itself, or a point on a directional light's near plane.
    position: vec3f,
    // 1 / size.
    step: f32,
    // Axes of the frame in world space, of length 1.
    forward: vec3f,
    // Texels across 1 in the world (directional), at distance 1 (spot).
    texels: f32,
    right: vec3f,
    // Texels along a side.
    size: f32,
    down: vec3f,
    // How far a spot reaches, squared; negative: nothing yet.
    reach: f32,
    // Biases: in world units, at distance 1 of a spot, and as a factor (spot) or a difference (directional)
    // of depth.
    normal_offset: f32,
    depth_bias: f32,
    // 1 for a spot, 0 for a directional light; 0.5 where nothing casts, for receivers of either.
    perspective: f32,
    // One step of the map's format; negative where nothing is in the map: all is lit.
    quantum: f32,
    // Coordinates of receivers are off by at most this part of themselves: docs/numerics.md, "Ulps of
    // positions".
    rounding: f32,
    // World width of a texel, at distance 1 of a spot.
    texel: f32,
    // How depth changes: by this over the distance (spot, the bias in it), by this times it (directional).
    depth_per: f32,
    // Depth of 16 widths of the map (directional).
    widths: f32,
}
