//! Sixteen lights in one pass: `reset` between two of them in place of a cleared stencil.

use shadows::glam::{Quat, Vec3};
use shadows::{
    Counter, HomogeneousLight, ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer,
    VolumeLight, wgpu,
};
use wgpu::util::DeviceExt as _;

use crate::kept::{Theatre, WALL};
use crate::passes::{attach, begin, clear, view_of};
use crate::pictures::{mixed, sun};
use host::gpu::Gpu;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
const LIGHTS: usize = 16;

/// Adds a light's own brightness wherever its count is 0.
const LIT: &str = "
@group(0) @binding(0) var<uniform> brightness: vec4f;
@vertex fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment fn lit() -> @location(0) vec4f {
    return brightness;
}
";

struct Host {
    pipeline: wgpu::RenderPipeline,
    lights: Vec<wgpu::BindGroup>,
    samples: u32,
}

impl Host {
    fn new(gpu: &Gpu, samples: u32) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(LIT.into()),
        });
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("screen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: ShadowVolumeDescriptor::default().depth_stencil_format,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: ShadowVolumeRenderer::light_pass_stencil(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: samples,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("lit"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: FORMAT,
                    blend: Some(wgpu::BlendState {
                        color: add,
                        alpha: add,
                    }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = |light: usize| {
            let brightness = [(1 + light) as f32 / 255.0; 4];
            let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: crate::passes::bytes_of(&brightness),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: buffer.as_entire_binding(),
                }],
            })
        };
        Self {
            lights: (0..LIGHTS).map(group).collect(),
            pipeline,
            samples,
        }
    }

    /// What all lights add up to, all in one pass.
    fn one_pass(
        &self,
        theatre: &Theatre,
        volumes: &mut ShadowVolumeRenderer,
        reset: bool,
    ) -> Vec<u8> {
        self.picture(theatre, |encoder, color, depth| {
            volumes.encode(encoder);
            let colors = [Some(clear(color, wgpu::Color::BLACK, None))];
            let mut pass = begin(encoder, "lights", &colors, attach(depth, Some(WALL)));
            let (lights, lit_pipeline) = (&self.lights, &self.pipeline);
            if !reset {
                for (light, bind_group) in lights.iter().enumerate() {
                    volumes.render(&mut pass, light, 0).unwrap();
                    self.add(&mut pass, bind_group);
                }
                return;
            }
            for (light, bind_group) in (0..).zip(lights) {
                if light > 0 {
                    volumes.reset(&mut pass);
                }
                volumes.render(&mut pass, light, 0).unwrap();
                pass.set_pipeline(lit_pipeline); // adds up, with light_pass_stencil()
                pass.set_stencil_reference(0);
                pass.set_bind_group(0, bind_group, &[]);
                pass.draw(0..3, 0..1);
            }
        })
    }

    /// The same with a pass for each light, its stencil cleared.
    fn many_passes(&self, theatre: &Theatre, volumes: &mut ShadowVolumeRenderer) -> Vec<u8> {
        self.picture(theatre, |encoder, color, depth| {
            volumes.encode(encoder);
            for (light, bind_group) in self.lights.iter().enumerate() {
                let mut target = clear(color, wgpu::Color::BLACK, None);
                if light > 0 {
                    target.ops.load = wgpu::LoadOp::Load;
                }
                let colors = [Some(target)];
                let mut pass = begin(encoder, "light", &colors, attach(depth, Some(WALL)));
                volumes.render(&mut pass, light, 0).unwrap();
                self.add(&mut pass, bind_group);
            }
        })
    }

    fn add(&self, pass: &mut wgpu::RenderPass<'_>, bind_group: &wgpu::BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_stencil_reference(0);
        pass.set_bind_group(0, bind_group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn picture(
        &self,
        theatre: &Theatre,
        draw: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::TextureView, &wgpu::TextureView),
    ) -> Vec<u8> {
        let gpu = &theatre.gpu;
        let format = ShadowVolumeDescriptor::default().depth_stencil_format;
        let size = [crate::kept::SIDE; 2];
        let color = gpu.target(size, FORMAT, self.samples);
        let depth = view_of(&gpu.target(size, format, self.samples));
        let picture = gpu.target(size, FORMAT, 1);
        gpu.checked(|| {
            gpu.run(|encoder| {
                draw(encoder, &view_of(&color), &depth);
                if self.samples > 1 {
                    let (color, resolved) = (view_of(&color), view_of(&picture));
                    let mut target = clear(&color, wgpu::Color::BLACK, Some(&resolved));
                    target.ops.load = wgpu::LoadOp::Load;
                    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                        color_attachments: &[Some(target)],
                        ..Default::default()
                    });
                }
            });
        });
        let read = if self.samples > 1 { &picture } else { &color };
        gpu.read_texture(read, 0, wgpu::TextureAspect::All)
    }
}

fn lights() -> Vec<VolumeLight> {
    let lamp = |n: usize| {
        let turn = Quat::from_rotation_y(n as f32 * 0.4);
        HomogeneousLight::point(turn * Vec3::new(-2.0, 6.0, 2.5)).into()
    };
    (0..LIGHTS).map(lamp).collect()
}

#[test]
fn sixteen_lights_in_one_pass_are_as_with_a_cleared_stencil_for_each() {
    let Some(gpu) = Gpu::for_test() else { return };
    let theatre = Theatre::new(gpu);
    let (device, queue) = (&theatre.gpu.device, &theatre.gpu.queue);
    let casters = theatre.casters(0..24);
    let frame = ShadowVolumeFrame {
        lights: &lights(),
        views: &[mixed(sun()).view().into()],
        casters: &casters,
        ..Default::default()
    };
    for samples in [1, 4] {
        let descriptor = ShadowVolumeDescriptor {
            color_formats: &[Some(FORMAT)],
            sample_count: samples,
            ..Default::default()
        };
        let mut volumes = ShadowVolumeRenderer::new(device, &descriptor).unwrap();
        volumes.prepare(device, queue, &frame).unwrap();
        let host = Host::new(&theatre.gpu, samples);
        let right = host.many_passes(&theatre, &mut volumes);
        let levels = |picture: &[u8]| {
            let mut levels = picture.to_vec();
            levels.sort_unstable();
            levels.dedup();
            levels.len()
        };
        // Each light's shadow is in it.
        assert!(levels(&right) > 12, "{}", levels(&right));
        assert!(right.contains(&136), "all of 1 + 2 + .. + 16");
        assert!(
            host.one_pass(&theatre, &mut volumes, true) == right,
            "{samples}x"
        );
        // The guard of one light leaves nothing to the next.
        assert!(
            host.one_pass(&theatre, &mut volumes, false) != right,
            "{samples}x"
        );
    }
}

#[test]
fn exact_counts_are_reset_too() {
    let Some(gpu) = crate::counts::gpu() else {
        return;
    };
    let theatre = Theatre::new(gpu);
    let gpu = &theatre.gpu;
    let casters = theatre.casters(0..24);
    let frame = ShadowVolumeFrame {
        lights: &lights(),
        views: &[mixed(sun()).view().into()],
        casters: &casters,
        ..Default::default()
    };
    let descriptor = ShadowVolumeDescriptor {
        counter: Counter::Exact,
        color_formats: &[Some(FORMAT)],
        ..Default::default()
    };
    let mut volumes = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    volumes.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    let size = [crate::kept::SIDE; 2];
    let depth = view_of(&gpu.target(size, descriptor.depth_stencil_format, 1));
    let color = gpu.target(size, FORMAT, 1);
    let mut counted = |lights: &[usize], reset: bool| {
        let counts = gpu.target(size, wgpu::TextureFormat::R32Float, 1);
        gpu.checked(|| {
            gpu.run(|encoder| {
                volumes.encode(encoder);
                let (color, counts) = (view_of(&color), view_of(&counts));
                let colors = [
                    Some(clear(&color, wgpu::Color::WHITE, None)),
                    Some(clear(&counts, wgpu::Color::TRANSPARENT, None)),
                ];
                let mut pass = begin(encoder, "counts", &colors, attach(&depth, Some(WALL)));
                for (place, &light) in lights.iter().enumerate() {
                    if reset && place > 0 {
                        volumes.reset(&mut pass);
                    }
                    volumes.render(&mut pass, light, 0).unwrap();
                }
            });
        });
        // The host's own target stays as it is.
        let color = gpu.read_texture(&color, 0, wgpu::TextureAspect::All);
        assert!(color.iter().all(|&value| value == 255));
        gpu.read_texture(&counts, 0, wgpu::TextureAspect::All)
    };
    let alone = counted(&[3], true);
    assert!(alone.iter().any(|&byte| byte != 0));
    assert!(counted(&[0, 1, 3], true) == alone);
    assert!(counted(&[0, 1, 3], false) != alone);
}
