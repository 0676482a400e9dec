// The same of one cube of an array.
fn shadows_cube_compare(
    map: texture_depth_cube_array,
    map_sampler: sampler_comparison,
    cube: i32,
    direction: vec3f,
    reference: f32,
) -> f32 {
    return textureSampleCompareLevel(map, map_sampler, direction, cube, reference);
}
