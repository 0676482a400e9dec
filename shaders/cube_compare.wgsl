// The share of the four texels around a direction that are no nearer to the light than `reference`,
// weighted by their distances: the sampler compares and blends.
fn shadows_cube_compare(
    map: texture_depth_cube,
    map_sampler: sampler_comparison,
    cube: i32,
    direction: vec3f,
    reference: f32,
) -> f32 {
    return textureSampleCompareLevel(map, map_sampler, direction, reference);
}
