// One bilinear compare tap, 2x2 texels (Reeves, Salesin and Cook, "Rendering Antialiased Shadows
// with Depth Maps", 1987: compare first, filter the results).

fn shadows_cube_bilinear(
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
    return shadows_cube_quad(map, map_sampler, receiver, light.size, corner, weight);
}
