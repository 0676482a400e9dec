//! What the host's shaders are told of the frame and its lights.

use shadows::glam::Mat4;
use shadows::wgpu;

use super::gpu::Gpu;
use super::scene::Scene;

/// `HostFrame` in host.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct FrameUniform {
    clip_from_world: [[f32; 4]; 4],
    world_from_clip: [[f32; 4]; 4],
    eye: [f32; 4],
    ambient: [f32; 4],
    horizon: [f32; 4],
    zenith: [f32; 4],
    light: LightUniform,
}

/// `HostLight` in host.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct LightUniform {
    place: [f32; 4],
    cone: [f32; 4],
    color: [f32; 4],
    range: f32,
    intensity: f32,
    number: u32,
    padding: u32,
}

/// What shaders are told of the frame, once for each light with that light. (A third uniform buffer in
/// the host's group crashes Mesa 22's lavapipe where a map's group brings another.)
pub(super) struct Uniforms {
    pub frames: wgpu::Buffer,
    pub stride: u32,
}

fn frame_uniform(scene: &Scene, clip_from_world: Mat4, light: usize) -> FrameUniform {
    let sky = &scene.sky;
    let color = |[r, g, b]: [f32; 3], a| [r, g, b, a];
    FrameUniform {
        clip_from_world: clip_from_world.to_cols_array_2d(),
        world_from_clip: clip_from_world.inverse().to_cols_array_2d(),
        eye: scene.camera.eye.extend(1.0).to_array(),
        ambient: color(sky.ambient, sky.haze),
        horizon: color(sky.horizon, 1.0),
        zenith: color(sky.zenith, 1.0),
        light: light_uniform(scene, light),
    }
}

fn light_uniform(scene: &Scene, number: usize) -> LightUniform {
    let light = &scene.lights[number];
    // A surface that faces the light at the picture's middle gets 1 - exp(-2.2) of full light,
    // whatever the scene's scale.
    let reach = light.place.truncate().distance(scene.camera.target);
    let at_target = 2.2
        * if light.place.w == 0.0 {
            1.0
        } else {
            reach * reach
        };
    let [r, g, b] = light.color;
    LightUniform {
        place: light.place.to_array(),
        // Direction and cosine; without a cone every angle's cosine is above the -1.
        cone: light.cone.map_or([0.0, 0.0, 0.0, -1.0], |cone| {
            let axis = cone.direction.normalize();
            axis.extend(cone.half_angle.cos()).to_array()
        }),
        color: [r, g, b, 1.0],
        range: light.range,
        intensity: light.intensity.unwrap_or(at_target),
        number: number as u32,
        padding: 0,
    }
}

impl Uniforms {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Self {
        let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment as usize;
        let stride = size_of::<FrameUniform>().next_multiple_of(alignment);
        Self {
            frames: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("frames"),
                size: (stride * scene.lights.len()) as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            stride: stride as u32,
        }
    }

    pub fn write(&self, gpu: &Gpu, scene: &Scene, clip_from_world: Mat4) {
        for light in 0..scene.lights.len() {
            let frame = frame_uniform(scene, clip_from_world, light);
            let at = light as u64 * u64::from(self.stride);
            gpu.queue
                .write_buffer(&self.frames, at, bytemuck::bytes_of(&frame));
        }
    }
}
