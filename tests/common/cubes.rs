//! Cube maps made, drawn and read back.
#![allow(dead_code)] // each test uses its own part

use shadows::{
    Caster, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, PointLight, wgpu,
};

use host::gpu::Gpu;

/// A frame of a map, drawn; any validation error panics.
pub fn draw(gpu: &Gpu, map: &mut CubeShadowMap, light: PointLight, casters: &[Caster]) {
    draw_frame(gpu, map, &CubeFrame::new(light, casters));
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
    light: PointLight,
    casters: &[Caster],
) -> CubeShadowMap {
    let mut map = gpu.checked(|| CubeShadowMap::new(&gpu.device, descriptor).unwrap());
    draw(gpu, &mut map, light, casters);
    map
}

/// The bytes of its six faces.
pub fn faces(gpu: &Gpu, map: &CubeShadowMap) -> Vec<Vec<u8>> {
    CubeFace::ALL
        .into_iter()
        .map(|face| gpu.read_texture(map.texture(), face.layer(), wgpu::TextureAspect::All))
        .collect()
}
