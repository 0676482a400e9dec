//! More volumes around one point than a byte can count.

use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Caps, Counter, HomogeneousLight, Method, ShadowMask, ShadowMaskDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeRenderer, wgpu,
};

use crate::choices::depths;
use crate::passes::{HostPipelines, LightPass, begin, clear, view_of};
use crate::pictures::{assert_exact, at, lamp, mixed};
use crate::shapes::{self, Shape};
use crate::stage::{Body, SIDE, Savings, Stage, WAYS};
use host::gpu::Gpu;

/// A device that counts in floats.
pub fn gpu() -> Option<Gpu> {
    let gpu = Gpu::for_test()?;
    if !gpu.support.float32_blending {
        eprintln!("skipped: no FLOAT32_BLENDABLE");
        return None;
    }
    Some(gpu)
}

/// Copies of a shape in a stack that is thinner than a pixel, under a light straight above: each
/// point is in all volumes or in none.
fn stack(shape: &Shape, flat: f32, count: u32) -> Stage {
    let bodies = (0..count).map(|layer| {
        let place = at(0.0, 1.0 + 2e-5 * layer as f32, 0.0);
        let scale = Affine3A::from_scale(Vec3::new(1.0, flat, 1.0));
        Body::caster(shape.clone(), place * scale)
    });
    Stage::new(HomogeneousLight::directional(Vec3::Y), bodies.collect())
}

pub fn sheets(count: u32) -> Stage {
    stack(&shapes::square(1.0), 1.0, count)
}

/// Boxes wound without a plan: both of a box's faces on the way to the light count.
pub fn boxes(count: u32) -> Stage {
    let shape = shapes::cube().turned(|triangle| triangle % 3 == 0);
    stack(&shape, 5e-6, count)
}

pub fn with(stage: &Stage, savings: Savings) -> Stage {
    Stage {
        savings,
        ..stage.clone()
    }
}

pub fn exact() -> Savings {
    Savings {
        counter: Counter::Exact,
        ..Default::default()
    }
}

/// The counts themselves.
pub fn exact_counts(gpu: &Gpu, stage: &Stage) -> Vec<f32> {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    let depth = view_of(&gpu.target([stage.side; 2], stage.format, 1));
    let (host, surfaces) = (HostPipelines::new(gpu, stage), stage.surfaces(gpu));
    let counts = stage.exact_count(gpu);
    gpu.checked(|| {
        gpu.run(|encoder| {
            renderer.encode(encoder);
            stage.prepass(encoder, &depth, &host, &surfaces);
            renderer
                .render(&mut counts.begin(encoder, &depth).unwrap(), 0, 0)
                .unwrap();
        });
    });
    let bytes = gpu.read_texture(counts.texture(), 0, wgpu::TextureAspect::All);
    bytemuck::pod_collect_to_vec(&bytes)
}

#[test]
fn no_number_of_sheets_is_lost() {
    let Some(gpu) = gpu() else { return };
    for count in [255, 256, 257, 512] {
        let stage = sheets(count);
        assert_exact(&gpu, &with(&stage, exact()), &format!("{count} sheets"));
        // A byte reads 0 in multiples of 256 volumes.
        let wrong = stage.truth().errors(&stage.draw(&gpu)).wrong;
        assert_eq!(wrong > 500, count % 256 == 0, "{count}: {wrong}");
    }
}

#[test]
fn both_sides_of_128_boxes_are_256_volumes() {
    let Some(gpu) = gpu() else { return };
    let stage = boxes(128);
    assert_exact(&gpu, &with(&stage, exact()), "128 boxes");
    assert!(stage.truth().errors(&stage.draw(&gpu)).wrong > 500);
}

#[test]
fn three_hundred_layers_read_300_and_not_44() {
    let Some(gpu) = gpu() else { return };
    let stage = sheets(300);
    let found = exact_counts(&gpu, &with(&stage, exact()));
    let deepest = found.iter().copied().fold(0.0, f32::max);
    assert_eq!(deepest, 300.0);
    let bytes = stage.counts(&gpu);
    for (float, byte) in found.iter().zip(&bytes) {
        assert_eq!(*float as i32 & 255, i32::from(*byte));
    }
    let pixel = found.iter().position(|count| *count == 300.0).unwrap();
    assert_eq!(bytes[pixel], 44);
}

#[test]
fn every_way_method_and_convention_counts_alike() {
    let Some(gpu) = gpu() else { return };
    let stage = mixed(lamp());
    for depth in depths(&gpu) {
        let stage = Stage {
            depth,
            ..stage.clone()
        };
        let truth = stage.truth();
        for silhouettes in WAYS {
            for (method, caps) in [(Method::ZFail, Caps::Full), (Method::Auto, Caps::AsNeeded)] {
                let stage = with(
                    &stage,
                    Savings {
                        silhouettes,
                        method,
                        caps,
                        ..exact()
                    },
                );
                let found = truth.errors(&stage.draw(&gpu));
                let what = format!("{depth:?} {silhouettes:?} {method:?}");
                assert_eq!(found.wrong, 0, "{what}: {found:?}");
            }
        }
    }
}

#[test]
fn z_fail_counts_behind_the_surface_and_z_pass_before_it() {
    let Some(gpu) = gpu() else { return };
    // From within the shadow, where the two differ.
    let stage = Stage {
        eye: Vec3::new(0.1, 0.6, 0.1),
        target: Vec3::new(3.0, 0.0, 2.0),
        near: 0.01,
        ..with(&sheets(3), exact())
    };
    assert_exact(&gpu, &stage, "from within");
    let savings = Savings {
        method: Method::ZPass,
        ..exact()
    };
    let wrong = with(&stage, savings);
    assert!(stage.truth().errors(&wrong.draw(&gpu)).wrong > 10_000);
}

#[test]
fn each_sample_is_counted_by_itself() {
    let Some(gpu) = gpu() else { return };
    let four = |stage: &Stage| Stage {
        samples: 4,
        ..stage.clone()
    };
    let stage = four(&with(&mixed(lamp()), exact()));
    let picture = stage.draw(&gpu);
    assert!(picture.iter().any(|&value| value > 0 && value < 255));
    assert_eq!(stage.truth().errors(&picture).wrong, 0);
    // 257 is 1 in a byte, so the stencil has the same picture to the last sample; 256 is 0.
    for (count, same) in [(257, true), (256, false)] {
        let stage = four(&sheets(count));
        assert_eq!(with(&stage, exact()).draw(&gpu) == stage.draw(&gpu), same);
    }
}

#[test]
fn the_guard_adds_light_once_however_often_the_scene_is_drawn() {
    let Some(gpu) = gpu() else { return };
    for samples in [1, 4] {
        let light_pass = |guarded| Stage {
            samples,
            light_pass: LightPass::Scene { times: 2, guarded },
            ..with(&mixed(lamp()), exact())
        };
        assert_eq!(light_pass(true).draw(&gpu).iter().max(), Some(&100));
        // At least twice: where two surfaces have the same depth at a sample, it is lit by both. (An
        // NVIDIA H100 gives 214, which is three samples of 200 and one of 255.)
        let most = light_pass(false).draw(&gpu).into_iter().max();
        assert!(most >= Some(200), "{samples}: {most:?}");
    }
}

#[test]
fn a_mask_is_filled_from_exact_counts() {
    let Some(gpu) = gpu() else { return };
    let stage = with(&sheets(256), exact());
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(&gpu, &mut renderer, &stage.casters(&gpu));
    let depth = view_of(&gpu.target([SIDE; 2], stage.format, 1));
    let (host, surfaces) = (HostPipelines::new(&gpu, &stage), stage.surfaces(&gpu));
    let counts = stage.exact_count(&gpu);
    let descriptor = ShadowMaskDescriptor {
        size: [SIDE; 2],
        ..Default::default()
    };
    let mask = ShadowMask::new(&gpu.device, &descriptor).unwrap();
    let mut fill = |marked: bool| {
        gpu.checked(|| {
            gpu.run(|encoder| {
                renderer.encode(encoder);
                stage.prepass(encoder, &depth, &host, &surfaces);
                renderer
                    .render(&mut counts.begin(encoder, &depth).unwrap(), 0, 0)
                    .unwrap();
                if marked {
                    counts.encode(encoder, &depth).unwrap();
                }
                mask.encode(encoder, 0, &depth).unwrap();
            });
        });
        let read = gpu.read_texture(mask.texture(), 0, wgpu::TextureAspect::All);
        stage.truth().errors(&read).wrong
    };
    assert_eq!(fill(true), 0);
    // The stencil knows nothing of the counts until it is marked.
    assert!(fill(false) > 500);
}

/// A lighting pass of the host's that reads the counts itself.
fn lit_by_shader(gpu: &Gpu, stage: &Stage) -> Vec<u8> {
    let multisampled = stage.samples > 1;
    let fragment = match multisampled {
        false => {
            shadows::wgsl::EXACT.to_owned()
                + "@group(0) @binding(0) var counts: texture_2d<f32>;
            @fragment fn light(@builtin(position) position: vec4f) -> @location(0) vec4f {
                return vec4f(shadows_exact_visibility(counts, position.xy));
            }"
        }
        true => {
            shadows::wgsl::EXACT_SAMPLES.to_owned()
                + "@group(0) @binding(0) var counts: texture_multisampled_2d<f32>;
            struct Lit { @builtin(sample_mask) samples: u32, @location(0) color: vec4f }
            @fragment fn light(@builtin(position) position: vec4f) -> Lit {
                return Lit(shadows_exact_lit_samples(counts, position.xy), vec4f(1.0));
            }"
        }
    };
    let source = fragment
        + "
        @vertex fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
            return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
        }";
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let binding = wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled,
        },
        count: None,
    };
    let groups = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[binding],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&groups)],
        immediate_size: 0,
    });
    let format = wgpu::TextureFormat::R8Unorm;
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState {
            count: stage.samples,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let mut renderer = ShadowVolumeRenderer::new(device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    let size = [stage.side; 2];
    let depth = view_of(&gpu.target(size, stage.format, stage.samples));
    let drawn = view_of(&gpu.target(size, format, stage.samples));
    let picture = gpu.target(size, format, 1);
    let resolved = view_of(&picture);
    let (host, surfaces) = (HostPipelines::new(gpu, stage), stage.surfaces(gpu));
    let counts = stage.exact_count(gpu);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &groups,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(counts.view()),
        }],
    });
    gpu.run(|encoder| {
        renderer.encode(encoder);
        stage.prepass(encoder, &depth, &host, &surfaces);
        renderer
            .render(&mut counts.begin(encoder, &depth).unwrap(), 0, 0)
            .unwrap();
        let target = match multisampled {
            false => clear(&resolved, wgpu::Color::BLACK, None),
            true => clear(&drawn, wgpu::Color::BLACK, Some(&resolved)),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(target)],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    });
    gpu.read_texture(&picture, 0, wgpu::TextureAspect::All)
}

#[test]
fn a_lighting_shader_may_read_the_counts() {
    let Some(gpu) = gpu() else { return };
    for samples in [1, 4] {
        for stage in [mixed(lamp()), sheets(256)] {
            let stage = Stage {
                samples,
                ..with(&stage, exact())
            };
            let picture = gpu.checked(|| lit_by_shader(&gpu, &stage));
            assert!(picture.contains(&0) && picture.contains(&255));
            let between = picture.iter().any(|&value| value > 0 && value < 255);
            assert_eq!(between, samples == 4);
            // The same as by the stencil that the counts are marked in, sample for sample.
            assert!(picture == stage.draw(&gpu));
        }
        // A count of 256 in a byte would leave no shadow.
        let stage = Stage {
            samples,
            ..sheets(256)
        };
        let exact = gpu.checked(|| lit_by_shader(&gpu, &with(&stage, exact())));
        assert!(exact != stage.draw(&gpu));
    }
}

#[test]
fn counts_come_after_the_hosts_own_targets() {
    let Some(gpu) = gpu() else { return };
    let stage = with(&sheets(256), exact());
    let formats = [Some(wgpu::TextureFormat::Rgba8Unorm), None];
    let descriptor = ShadowVolumeDescriptor {
        color_formats: &formats,
        ..stage.descriptor()
    };
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap();
    stage.prepare(&gpu, &mut renderer, &stage.casters(&gpu));
    let depth = view_of(&gpu.target([SIDE; 2], stage.format, 1));
    let (host, surfaces) = (HostPipelines::new(&gpu, &stage), stage.surfaces(&gpu));
    let counts = stage.exact_count(&gpu);
    let color = gpu.target([SIDE; 2], wgpu::TextureFormat::Rgba8Unorm, 1);
    let color_view = view_of(&color);
    gpu.checked(|| {
        gpu.run(|encoder| {
            renderer.encode(encoder);
            stage.prepass(encoder, &depth, &host, &surfaces);
            let colors = [
                Some(clear(&color_view, wgpu::Color::RED, None)),
                None,
                Some(clear(counts.view(), wgpu::Color::TRANSPARENT, None)),
            ];
            let attachment = wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: None,
                stencil_ops: None,
            };
            renderer
                .render(&mut begin(encoder, "counts", &colors, attachment), 0, 0)
                .unwrap();
        });
    });
    let bytes = gpu.read_texture(counts.texture(), 0, wgpu::TextureAspect::All);
    let found: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
    assert!(found == exact_counts(&gpu, &stage));
    assert!(found.contains(&256.0));
    let color = gpu.read_texture(&color, 0, wgpu::TextureAspect::All);
    assert!(color.chunks(4).all(|texel| texel == [255, 0, 0, 255]));
}
