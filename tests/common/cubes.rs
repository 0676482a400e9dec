//! Cube maps made, drawn and read back.
#![allow(dead_code)] // each test uses its own part

use shadows::{
    Caster, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, PointLight, wgpu,
};

use host::gpu::Gpu;

/// A frame of a map, drawn; any validation error panics.
pub fn draw(gpu: &Gpu, map: &mut CubeShadowMap, lights: &[PointLight], casters: &[Caster]) {
    let frame = CubeFrame {
        lights,
        casters,
        ..Default::default()
    };
    draw_frame(gpu, map, &frame);
}

pub fn draw_frame(gpu: &Gpu, map: &mut CubeShadowMap, frame: &CubeFrame<'_>) {
    gpu.checked(|| {
        map.prepare(&gpu.device, &gpu.queue, frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
    });
}

/// A new map, drawn once.
pub fn fresh(
    gpu: &Gpu,
    descriptor: &CubeShadowMapDescriptor<'_>,
    lights: &[PointLight],
    casters: &[Caster],
) -> CubeShadowMap {
    let mut map = gpu.checked(|| CubeShadowMap::new(&gpu.device, descriptor).unwrap());
    draw(gpu, &mut map, lights, casters);
    map
}

/// The bytes of a light's six faces; none if it has no texels.
pub fn faces(gpu: &Gpu, map: &CubeShadowMap, light: usize) -> Vec<Vec<u8>> {
    let Some((texture, first)) = map.texture(light) else {
        return Vec::new();
    };
    CubeFace::ALL
        .into_iter()
        .map(|face| gpu.read_texture(texture, first + face.layer(), wgpu::TextureAspect::All))
        .collect()
}
