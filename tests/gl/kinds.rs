//! Arrays that the back end would take for something else.

use shadows::error::CubeShadowMapError;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    AtlasFrame, AtlasLight, Caster, CubeCross, CubeCrossDescriptor, CubeShadowMap,
    CubeShadowMapDescriptor, Kernel, MapKind, PcfDescriptor, PcfSampler, PointLight, ShadowAtlas,
    ShadowAtlasDescriptor, ShadowMask, ShadowMaskDescriptor, TileSize, wgpu,
};

use crate::common::shapes::{Random, cuboid};
use crate::gl;
use crate::receivers::{ask, ask_changed};
use host::gpu::Gpu;

/// A mask of so many lights, every third of which is in shadow.
fn mask(gpu: &Gpu, size: [u32; 2], lights: u32, samples: u32) -> ShadowMask {
    let format = wgpu::TextureFormat::Depth24PlusStencil8;
    let descriptor = ShadowMaskDescriptor {
        size,
        lights,
        depth_stencil_format: format,
        sample_count: samples,
        ..Default::default()
    };
    let mask = ShadowMask::new(&gpu.device, &descriptor).unwrap();
    let buffer = gpu.target(size, format, samples);
    let buffer = buffer.create_view(&Default::default());
    for light in 0..lights {
        gpu.run(|encoder| {
            let count = u32::from(light % 3 == 1);
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &buffer,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Clear(count),
                        store: wgpu::StoreOp::Store,
                    }),
                }),
                ..Default::default()
            }));
            mask.encode(encoder, light, &buffer).unwrap();
        });
    }
    mask
}

/// What `wgsl::MASK` reads of each light.
fn read(gpu: &Gpu, mask: &wgpu::TextureView, lights: u32) -> Vec<f32> {
    let source = shadows::wgsl::MASK.to_owned()
        + "@group(1) @binding(0) var mask: texture_2d_array<f32>;
        fn ask(i: u32) -> f32 {
            return shadows_mask(mask, vec2f(3.5, 4.5), i32(i));
        }";
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
                count: None,
            }],
        });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(mask),
        }],
    });
    crate::ask(gpu, &source, (&layout, &group), lights)
}

#[test]
fn masks_of_any_number_of_lights_are_read_as_they_are() {
    let Some(gpu) = gl() else { return };
    for size in [[8, 8], [8, 16]] {
        for (lights, samples) in [
            (1, 1),
            (1, 4),
            (2, 1),
            (5, 1),
            (6, 1),
            (6, 4),
            (7, 1),
            (12, 1),
        ] {
            let mask = mask(&gpu, size, lights, samples);
            let right: Vec<f32> = (0..lights).map(|l| f32::from(l % 3 != 1)).collect();
            let found = read(&gpu, mask.view(), lights);
            assert_eq!(found, right, "{lights} lights, {samples} samples, {size:?}");
        }
    }
}

/// The broken twin: a host's own array of so many white layers, as `read` sees the first.
fn white(gpu: &Gpu, layers: u32) -> f32 {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: 8,
            height: 8,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    for layer in 0..layers {
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        gpu.run(|encoder| {
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            }));
        });
    }
    let array = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    read(gpu, &array, 1)[0]
}

#[test]
fn without_a_spare_layer_they_would_read_nothing() {
    let Some(gpu) = gl() else { return };
    for (layers, right) in [(1, false), (2, true), (6, false), (7, true), (12, false)] {
        assert_eq!(white(&gpu, layers) == 1.0, right, "{layers}");
    }
}

const LIGHT: Vec3 = Vec3::new(0.0, 3.0, 0.0);

fn casters(gpu: &Gpu) -> Vec<Caster> {
    let mut random = Random::new(21);
    let mesh = cuboid(Vec3::new(0.25, 0.15, 0.2)).mesh(&gpu.device);
    (0..10)
        .map(|_| random.vec3() * Vec3::new(1.2, 0.5, 1.2) + Vec3::Y * 0.8)
        .map(|place| Caster::new(mesh.clone(), Affine3A::from_translation(place)))
        .collect()
}

fn light() -> PointLight {
    PointLight::new(LIGHT, 30.0)
}

/// A light over some boxes.
fn cube(gpu: &Gpu) -> CubeShadowMap {
    let descriptor = CubeShadowMapDescriptor {
        size: 128,
        ..Default::default()
    };
    crate::cubes::fresh(gpu, &descriptor, light(), &casters(gpu))
}

/// The same light so many times.
fn atlas(gpu: &Gpu, lights: usize) -> ShadowAtlas {
    let descriptor = ShadowAtlasDescriptor {
        layer_size: 128,
        ..Default::default()
    };
    let mut atlas = ShadowAtlas::new(&gpu.device, &descriptor).unwrap();
    let casters = casters(gpu);
    let light = AtlasLight::new(light()).with_size(TileSize::Fixed(128));
    let frame = AtlasFrame {
        lights: &vec![light; lights],
        casters: &casters,
        ..Default::default()
    };
    gpu.checked(|| {
        atlas.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| atlas.encode(encoder));
    });
    atlas
}

#[test]
fn atlases_of_any_number_of_lights_are_read_as_a_map_of_one() {
    let Some(gpu) = gl() else { return };
    let mut random = Random::new(4);
    let points: Vec<_> = (0..2000)
        .map(|_| Vec3::new(random.next() * 2.2, 0.0, random.next() * 2.2))
        .map(|point| (point, Vec3::Y))
        .collect();
    for kernel in [Kernel::Hard, Kernel::Weighted5, Kernel::HardwareBilinear] {
        let one = PcfDescriptor {
            kernel,
            ..Default::default()
        };
        let many = PcfDescriptor {
            map: MapKind::ATLAS,
            ..one.clone()
        };
        let right = ask(&gpu, &cube(&gpu), &one, 0, &points);
        assert!(right.iter().filter(|&&lit| lit < 0.5).count() > 100);
        for lights in [1, 2, 3] {
            let atlas = atlas(&gpu, lights);
            for light in 0..lights {
                let found = ask(&gpu, &atlas, &many, light, &points);
                assert!(found == right, "light {light} of {lights}, {kernel:?}");
            }
            // The broken twin: the opposite face.
            let change = |module: String| {
                assert!(module.contains("i32(packed >> 20u)"));
                module.replace("i32(packed >> 20u)", "(i32(packed >> 20u) ^ 1)")
            };
            let other = ask_changed(&gpu, (&atlas).into(), &many, lights - 1, &points, change);
            assert!(other != right, "{lights}, {kernel:?}");
        }
    }
}

#[test]
fn a_cube_view_is_refused_and_nothing_else() {
    let Some(gpu) = gl() else { return };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let sampler = PcfSampler::new(device, queue, &PcfDescriptor::default()).unwrap();
    let cross = CubeCross::new(device, &CubeCrossDescriptor::default()).unwrap();
    let map = cube(&gpu);
    assert_eq!(map.view().unwrap_err(), CubeShadowMapError::CubeView);
    sampler.bind_group(device, &map).unwrap();
    cross.bind_group(device, &map).unwrap();
    // A spare layer, without which the back end takes it for a cube.
    assert_eq!(map.texture().depth_or_array_layers(), 7);
    let Ok(other) = Gpu::new(Some("(vulkan,")) else {
        eprintln!("skipped: no Vulkan adapter to compare with");
        return;
    };
    cube(&other).view().unwrap();
}
