// Four bilinear compare taps one texel away on the diagonals: 4x4 texels in all.

fn shadows_cube_four_taps(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,
    position: vec3f,
    normal: vec3f,
) -> f32 {
    let receiver = shadows_cube_receiver(light, position, normal);
    if receiver.known >= 0.0 {
        return receiver.known;
    }
    let corner = floor(receiver.texel + 0.5);
    let weight = receiver.texel + 0.5 - corner;
    let size = light.size;
    let a = shadows_cube_quad(map, map_sampler, receiver, size, corner + vec2f(-1.0, -1.0), weight);
    let b = shadows_cube_quad(map, map_sampler, receiver, size, corner + vec2f(1.0, -1.0), weight);
    let c = shadows_cube_quad(map, map_sampler, receiver, size, corner + vec2f(-1.0, 1.0), weight);
    let d = shadows_cube_quad(map, map_sampler, receiver, size, corner + vec2f(1.0, 1.0), weight);
    return 0.25 * (a + b + c + d);
}
