//! The forms of the light pass beside the stencil state: a mask to sample, and targets joined.

use shadows::error::ScreenPassError as Error;
use shadows::{
    LightJoin, LightJoinDescriptor, ShadowMask, ShadowMaskDescriptor, ShadowVolumeRenderer, wgpu,
};

use crate::errors::bare;
use crate::passes::{HostPipelines, attach, begin, clear, view_of};
use crate::pictures::{lamp, mixed, sun};
use crate::stage::{SIDE, Stage};
use host::gpu::Gpu;

const SIZE: [u32; 2] = [SIDE, SIDE];

/// Draws a stage's depth and counts its volumes in the stencil of `depth`.
fn count(gpu: &Gpu, stage: &Stage, depth: &wgpu::TextureView) {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    let host = HostPipelines::new(gpu, stage);
    let surfaces = stage.surfaces(gpu);
    gpu.run(|encoder| {
        renderer.encode(encoder);
        let attachment = attach(depth, Some(stage.depth.clear_depth()));
        let mut pass = begin(encoder, "depth prepass", &[], attachment);
        pass.set_pipeline(&host.depth);
        surfaces.iter().for_each(|surface| surface.draw(&mut pass));
        drop(pass);
        renderer
            .render(
                &mut begin(encoder, "stencil", &[], attach(depth, None)),
                0,
                0,
            )
            .unwrap();
    });
}

fn with_samples(stage: Stage, samples: u32) -> Stage {
    Stage { samples, ..stage }
}

/// The layers of a mask of two lights.
fn masks(gpu: &Gpu, samples: u32) -> [Vec<u8>; 2] {
    let descriptor = ShadowMaskDescriptor {
        size: SIZE,
        lights: 2,
        sample_count: samples,
        ..Default::default()
    };
    let mask = ShadowMask::new(&gpu.device, &descriptor).unwrap();
    for (layer, light) in [(0, lamp()), (1, sun())] {
        let stage = with_samples(mixed(light), samples);
        let depth = view_of(&gpu.target(SIZE, stage.format, samples));
        count(gpu, &stage, &depth);
        gpu.run(|encoder| mask.encode(encoder, layer, &depth).unwrap());
    }
    [0, 1].map(|layer| gpu.read_texture(mask.texture(), layer, wgpu::TextureAspect::All))
}

#[test]
fn a_mask_holds_what_the_stencil_says_of_every_light() {
    let Some(gpu) = Gpu::for_test() else { return };
    for samples in [1, 4] {
        let found = gpu.checked(|| masks(&gpu, samples));
        for (mask, light) in found.iter().zip([lamp(), sun()]) {
            let stage = with_samples(mixed(light), samples);
            assert_eq!(stage.truth().errors(mask).wrong, 0, "{samples} samples");
            assert!(*mask == stage.draw(&gpu), "{samples} samples");
        }
        // The layers are those of two lights, not of one.
        assert!(mixed(sun()).truth().errors(&found[0]).wrong > 500);
    }
}

#[test]
fn a_shader_reads_its_own_pixel_of_a_mask() {
    let Some(gpu) = Gpu::for_test() else { return };
    let source = shadows::wgsl::MASK.to_owned()
        + "
        @group(0) @binding(0) var mask: texture_2d_array<f32>;
        @vertex fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
            return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
        }
        @fragment fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
            return vec4f(shadows_mask(mask, position.xy, 0));
        }";
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
    let target = wgpu::TextureFormat::R8Unorm;
    let pipeline = gpu
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(target.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
    let stage = mixed(lamp());
    let descriptor = ShadowMaskDescriptor {
        size: SIZE,
        ..Default::default()
    };
    let mask = ShadowMask::new(&gpu.device, &descriptor).unwrap();
    let depth = view_of(&gpu.target(SIZE, stage.format, 1));
    count(&gpu, &stage, &depth);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(mask.view()),
        }],
    });
    let picture = gpu.target(SIZE, target, 1);
    let show = || {
        gpu.run(|encoder| {
            let view = view_of(&picture);
            let color = Some(clear(&view, wgpu::Color::RED, None));
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[color],
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        });
        gpu.read_texture(&picture, 0, wgpu::TextureAspect::All)
    };
    // Before anything was copied into it, all is in shadow.
    assert!(stage.truth().errors(&show()).wrong > 500);
    gpu.run(|encoder| mask.encode(encoder, 0, &depth).unwrap());
    assert_eq!(stage.truth().errors(&show()).wrong, 0);
}

/// A picture of one colour, as the host's targets would be.
fn filled(gpu: &Gpu, value: f64, samples: u32) -> wgpu::TextureView {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: SIDE,
            height: SIDE,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = view_of(&texture);
    let color = wgpu::Color {
        r: value / 255.0,
        g: value / 255.0,
        b: value / 255.0,
        a: 1.0,
    };
    gpu.run(|encoder| {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(clear(&view, color, None))],
            ..Default::default()
        });
    });
    view
}

#[test]
fn ambient_and_direct_light_are_joined_where_the_light_reaches() {
    let Some(gpu) = Gpu::for_test() else { return };
    for samples in [1, 4] {
        let stage = with_samples(mixed(lamp()), samples);
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let descriptor = LightJoinDescriptor {
            sample_count: samples,
            ..Default::default()
        };
        if samples > 1 && gpu.info.backend == wgpu::Backend::Gl {
            LightJoin::new(&gpu.device, &descriptor).unwrap_err();
            continue;
        }
        let join = LightJoin::new(&gpu.device, &descriptor).unwrap();
        let [ambient, direct] =
            [40.0, 160.0].map(|value| join.bind(&filled(&gpu, value, samples)).unwrap());
        let depth = view_of(&gpu.target(SIZE, stage.format, samples));
        count(&gpu, &stage, &depth);
        let picture = gpu.target(SIZE, format, 1);
        let drawn = view_of(&gpu.target(SIZE, format, samples));
        let resolved = view_of(&picture);
        gpu.checked(|| {
            gpu.run(|encoder| {
                let target = match samples {
                    1 => clear(&resolved, wgpu::Color::RED, None),
                    _ => clear(&drawn, wgpu::Color::RED, Some(&resolved)),
                };
                let mut pass = begin(encoder, "join", &[Some(target)], attach(&depth, None));
                join.render_ambient(&mut pass, &ambient);
                join.render_lit(&mut pass, &direct);
            });
        });
        let rgba = gpu.read_texture(&picture, 0, wgpu::TextureAspect::All);
        let (pixels, _) = rgba.as_chunks::<4>();
        assert!(
            pixels
                .iter()
                .all(|&[r, g, b, a]| r == g && g == b && a == 255)
        );
        assert!(pixels.iter().all(|p| (40..=200).contains(&p[0])));
        let lit: Vec<u8> = pixels
            .iter()
            .map(|p| ((u32::from(p[0]) - 40) * 255 / 160) as u8)
            .collect();
        let found = stage.truth().errors(&lit);
        assert!(
            found.shadowed > 500 && found.wrong == 0,
            "{samples}: {found:?}"
        );
        // With nothing counted, all is lit.
        let all = vec![255; lit.len()];
        assert!(stage.truth().errors(&all).wrong > 500);
    }
}

#[test]
fn masks_and_joins_that_do_not_fit_are_refused() {
    let (device, _queue) = bare();
    let ok = ShadowMaskDescriptor {
        size: [64, 32],
        ..Default::default()
    };
    let refused = |descriptor: ShadowMaskDescriptor<'_>| {
        ShadowMask::new(&device, &descriptor)
            .map(|_| ())
            .unwrap_err()
    };
    let limits = device.limits();
    for (size, what, value) in [([0, 32], "width", 0), ([64, 1 << 20], "height", 1 << 20)] {
        let limit = limits.max_texture_dimension_2d;
        let error = Error::Range { what, value, limit };
        assert_eq!(refused(ShadowMaskDescriptor { size, ..ok }), error);
    }
    assert!(matches!(
        refused(ShadowMaskDescriptor { lights: 0, ..ok }),
        Error::Range {
            what: "number of lights",
            value: 0,
            ..
        }
    ));
    let format = wgpu::TextureFormat::Depth32Float;
    let descriptor = ShadowMaskDescriptor {
        depth_stencil_format: format,
        ..ok
    };
    assert_eq!(refused(descriptor), Error::Format(format));
    let (without_floats, _queue) = wgpu::Device::noop(&Default::default());
    assert_eq!(
        ShadowMask::new(&without_floats, &ok).err(),
        Some(Error::Format(ok.depth_stencil_format))
    );
    let descriptor = ShadowMaskDescriptor {
        sample_count: 2,
        ..ok
    };
    assert_eq!(refused(descriptor), Error::SampleCount(2));

    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let mask = ShadowMask::new(&device, &ok).unwrap();
    let buffer = |size: [u32; 2]| {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: ok.depth_stencil_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        view_of(&texture)
    };
    let mut encoder = device.create_command_encoder(&Default::default());
    let error = Error::Layer {
        light: 1,
        lights: 1,
    };
    assert_eq!(mask.encode(&mut encoder, 1, &buffer([64, 32])), Err(error));
    assert!(matches!(
        mask.encode(&mut encoder, 0, &buffer([32, 64])),
        Err(Error::Buffer {
            found: [32, 64, 1],
            needed: [64, 32, 1],
            ..
        })
    ));
    assert_eq!(mask.encode(&mut encoder, 0, &buffer([64, 32])), Ok(()));
    drop(encoder.finish());

    let join = |descriptor| LightJoin::new(&device, &descriptor);
    let four = LightJoinDescriptor {
        sample_count: 4,
        ..Default::default()
    };
    assert_eq!(
        join(four).unwrap().bind(&buffer([64, 32])).unwrap_err(),
        Error::Source {
            found: 1,
            needed: 4
        }
    );
    let color_format = wgpu::TextureFormat::R32Uint;
    let descriptor = LightJoinDescriptor {
        color_format,
        ..Default::default()
    };
    assert_eq!(
        join(descriptor).unwrap_err(),
        Error::ColorFormat(color_format)
    );
    let join = join(LightJoinDescriptor::default()).unwrap();
    let source = |format, usage| {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: Default::default(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        join.bind(&view_of(&texture)).map(drop)
    };
    use wgpu::{TextureFormat as F, TextureUsages as U};
    for (format, usage) in [
        (F::Rgba8Unorm, U::RENDER_ATTACHMENT),
        (F::Rgba8Uint, U::TEXTURE_BINDING),
        (F::Depth32Float, U::TEXTURE_BINDING),
    ] {
        let error = Error::Unreadable { format, usage };
        assert_eq!(source(format, usage), Err(error));
    }
    assert_eq!(source(F::Rgba32Float, U::TEXTURE_BINDING), Ok(()));
    assert_eq!(pollster::block_on(scope.pop()).map(|e| e.to_string()), None);
}
