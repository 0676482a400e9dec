// What receivers know of a light, as the map writes it.

struct ShadowsCubeLight {
    // World space.
    position: vec3f,
    near: f32,
    range: f32,
    // Texels along a face.
    size: f32,
    // Biases; a texel at distance 1 along the major axis is 2 / size wide.
    normal_offset: f32,
    // near over `half_size`, with the bias of depths.
    scale: f32,
    // One step of the map's format.
    quantum: f32,
    // Which cube of the array; -1: no caster in range, -2: not drawn yet.
    cube: i32,
    // Coordinates of receivers are off by at most this part of themselves: docs/numerics.md, "Ulps of
    // positions".
    rounding: f32,
    // Where texel centres are between whole numbers, counted in texels from the middle of a face: 0.5 if
    // the size is even, else 0.
    centre: f32,
    // What would be the same for every receiver: a little less than half of the size, so that scaled by it
    // no direction is rounded to beyond a face; 2 / size; the range, squared; the depth that
    // bounds those of planes, for a receiver at distance `half_size` along the major axis.
    half_size: f32,
    texel: f32,
    range_squared: f32,
    bound: f32,
    // Half of the size: the middle of a face, in texels from its corner; and one over the size.
    middle: f32,
    step: f32,
    // WebGL 2 takes uniforms in units of 16 bytes.
    padding: vec2f,
}
