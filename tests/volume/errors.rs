//! Every error is reached, before any GPU work, and leaves the renderer usable. No driver needed.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::error::{CasterError, LightError, ShadowVolumeError as Error};
use shadows::glam::camera::rh::proj::directx as proj;
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::{Adjacency, Bounds};
use shadows::{
    Caster, CasterMesh, Counter, DepthConvention, HomogeneousLight, HostMesh, Method,
    ShadowVolumeDescriptor, ShadowVolumeRenderer, Silhouettes, View, VolumeCone, wgpu,
};

use crate::shapes;

pub fn noop(features: wgpu::Features, limits: wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_features: features,
        required_limits: limits,
        ..Default::default()
    })
}

/// What the default depth-stencil format needs.
pub const FLOAT: wgpu::Features = wgpu::Features::DEPTH32FLOAT_STENCIL8;

/// Nothing but that.
pub fn bare() -> (wgpu::Device, wgpu::Queue) {
    noop(FLOAT, wgpu::Limits::defaults())
}

/// Devices are told apart within one instance only.
pub fn two_devices() -> [(wgpu::Device, wgpu::Queue); 2] {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions {
            noop: wgpu::NoopBackendOptions::enabled(),
            ..Default::default()
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let device = || async {
        let adapter = instance.request_adapter(&Default::default()).await.unwrap();
        let descriptor = wgpu::DeviceDescriptor {
            required_features: FLOAT,
            ..Default::default()
        };
        adapter.request_device(&descriptor).await.unwrap()
    };
    [pollster::block_on(device()), pollster::block_on(device())]
}

fn new(device: &wgpu::Device, descriptor: ShadowVolumeDescriptor<'_>) -> Result<(), Error> {
    ShadowVolumeRenderer::new(device, &descriptor).map(|_| ())
}

fn by_compute() -> ShadowVolumeDescriptor<'static> {
    ShadowVolumeDescriptor {
        silhouettes: Silhouettes::Compute,
        ..Default::default()
    }
}

pub fn view(depth: DepthConvention) -> View {
    let projection = match depth {
        DepthConvention::InfiniteReverse => proj::perspective_infinite_reverse(0.9, 1.0, 0.1),
        DepthConvention::FiniteReverse => proj::perspective(0.9, 1.0, 100.0, 0.1),
        DepthConvention::Standard => proj::perspective(0.9, 1.0, 0.1, 100.0),
    };
    View::new(projection, depth).unwrap()
}

fn cube(device: &wgpu::Device) -> CasterMesh {
    let cube = shapes::cube();
    let adjacency = Adjacency::new(&cube.positions, &cube.indices).unwrap();
    CasterMesh::new(device, &cube.positions, &adjacency).unwrap()
}

/// A triangle of which only shadow maps know enough.
fn for_maps(device: &wgpu::Device) -> CasterMesh {
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 36,
            usage,
            mapped_at_creation: false,
        })
    };
    let mesh = HostMesh {
        vertices: &buffer(wgpu::BufferUsages::VERTEX),
        stride: 12,
        offset: 0,
        indices: &buffer(wgpu::BufferUsages::INDEX),
        index_format: wgpu::IndexFormat::Uint32,
        index_offset: 0,
        index_count: 3,
        bounds: Bounds {
            min: Vec3::ZERO,
            max: Vec3::ZERO,
        },
    };
    CasterMesh::from_host(device, &mesh).unwrap()
}

pub fn cubes(device: &wgpu::Device, count: usize) -> Vec<Caster> {
    let mesh = cube(device);
    let place = |i| Affine3A::from_translation(Vec3::new(0.0, 0.0, -5.0 - 3.0 * i as f32));
    (0..count)
        .map(|i| Caster::new(mesh.clone(), place(i)))
        .collect()
}

pub const LIGHT: HomogeneousLight = HomogeneousLight::point(Vec3::new(0.0, 9.0, 0.0));

#[test]
fn a_descriptor_that_does_not_fit_is_refused() {
    let (device, _) = bare();
    let ok = ShadowVolumeDescriptor::default();
    for format in [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Stencil8,
        wgpu::TextureFormat::Rgba8Unorm,
    ] {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: format,
            ..ok
        };
        assert_eq!(new(&device, descriptor), Err(Error::Format(format)));
    }
    for sample_count in [0, 2, 8, u32::MAX] {
        let descriptor = ShadowVolumeDescriptor { sample_count, ..ok };
        assert_eq!(
            new(&device, descriptor),
            Err(Error::SampleCount(sample_count))
        );
    }
    let format = wgpu::TextureFormat::Depth32Float;
    let descriptor = ShadowVolumeDescriptor {
        color_formats: &[None, Some(format)],
        ..ok
    };
    assert_eq!(
        new(&device, descriptor),
        Err(Error::ColorFormat { place: 1, format })
    );
    let nine = [Some(wgpu::TextureFormat::R8Unorm); 9];
    let descriptor = ShadowVolumeDescriptor {
        color_formats: &nine,
        ..ok
    };
    let limit = "max_color_attachments";
    assert!(matches!(new(&device, descriptor), Err(Error::Limit { name, .. }) if name == limit));
    // 3 times 16 bytes; and with the counts' 4, one more than twice 16 would be.
    let wide = [Some(wgpu::TextureFormat::Rgba32Float); 3];
    let limit = |needed| Error::Limit {
        name: "max_color_attachment_bytes_per_sample",
        needed,
        available: 32,
    };
    let descriptor = ShadowVolumeDescriptor {
        color_formats: &wide,
        ..ok
    };
    assert_eq!(new(&device, descriptor), Err(limit(48)));
    let (counting, _) = noop(
        FLOAT | wgpu::Features::FLOAT32_BLENDABLE,
        wgpu::Limits::defaults(),
    );
    let descriptor = ShadowVolumeDescriptor {
        color_formats: &wide[..2],
        ..ok
    };
    assert_eq!(new(&counting, descriptor), Ok(()));
    let descriptor = ShadowVolumeDescriptor {
        counter: Counter::Exact,
        ..descriptor
    };
    assert_eq!(new(&counting, descriptor), Err(limit(36)));
    assert_eq!(new(&device, ok), Ok(()));
}

/// Whether wgpu itself takes what `make` does.
fn is_valid(device: &wgpu::Device, make: impl FnOnce()) -> bool {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    make();
    pollster::block_on(scope.pop()).is_none()
}

#[test]
fn colour_formats_are_refused_where_wgpu_would_refuse_them_and_nowhere_else() {
    use wgpu::TextureFormat as F;
    let (device, _) = bare();
    let formats = [
        F::R8Unorm,
        F::R8Snorm,
        F::Rg8Snorm,
        F::R32Uint,
        F::R32Float,
        F::Rg32Float,
        F::Rgba32Float,
        F::Rgba8Snorm,
        F::Rgba8UnormSrgb,
        F::Rgba16Float,
        F::Rgb10a2Unorm,
        F::Rg11b10Ufloat,
        F::Rgb9e5Ufloat,
    ];
    let mut taken = 0;
    for (format, sample_count) in formats.into_iter().flat_map(|f| [(f, 1), (f, 4)]) {
        let descriptor = ShadowVolumeDescriptor {
            sample_count,
            color_formats: &[Some(format)],
            ..Default::default()
        };
        let mut result = Ok(());
        let silent = is_valid(&device, || result = new(&device, descriptor));
        assert!(silent, "{format:?}, {sample_count}x: {result:?}");
        let drawable = is_valid(&device, || {
            let _ = device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: Default::default(),
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
        });
        let right = match drawable {
            true => Ok(()),
            false => Err(Error::ColorFormat { place: 0, format }),
        };
        assert_eq!(result, right, "{sample_count}x");
        taken += i32::from(drawable);
    }
    assert!(taken > 10 && taken < 20, "{taken}");
}

#[test]
fn missing_features_are_named() {
    let clip = wgpu::Features::DEPTH_CLIP_CONTROL;
    let (device, _) = bare();
    let ok = ShadowVolumeDescriptor::default();
    let missing = |descriptor, wanted| match new(&device, descriptor) {
        Err(Error::MissingFeature { feature, needed_by }) => {
            assert_eq!(feature, wanted);
            assert!(!needed_by.is_empty());
        }
        other => panic!("{other:?}"),
    };
    for depth in [DepthConvention::Standard, DepthConvention::FiniteReverse] {
        let descriptor = ShadowVolumeDescriptor { depth, ..ok };
        missing(descriptor, clip);
        let (device, _) = noop(FLOAT | clip, wgpu::Limits::defaults());
        assert_eq!(new(&device, descriptor), Ok(()));
    }
}

#[test]
fn without_floats_beside_a_stencil_the_default_says_what_to_pass() {
    let (device, _) = noop(wgpu::Features::empty(), wgpu::Limits::defaults());
    let ok = ShadowVolumeDescriptor::default();
    let error = new(&device, ok).unwrap_err();
    assert_eq!(error, Error::FormatFeature(ok.depth_stencil_format));
    let said = error.to_string();
    assert!(said.contains("Support::depth_stencil_format()"), "{said}");
    let every_device_has_it = ShadowVolumeDescriptor {
        depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
        ..ok
    };
    assert_eq!(new(&device, every_device_has_it), Ok(()));
    let (device, _) = bare();
    assert_eq!(new(&device, ok), Ok(()));
}

#[test]
fn limits_that_are_too_low_are_named() {
    let limits = wgpu::Limits {
        max_storage_buffers_per_shader_stage: 4,
        ..wgpu::Limits::defaults()
    };
    let (device, _) = noop(FLOAT, limits);
    assert_eq!(
        new(&device, by_compute()),
        Err(Error::Limit {
            name: "max_storage_buffers_per_shader_stage",
            needed: 7,
            available: 4
        })
    );
    let (device, _) = noop(FLOAT, wgpu::Limits::downlevel_webgl2_defaults());
    let error = new(&device, by_compute());
    assert!(matches!(error, Err(Error::Limit { .. })), "{error:?}");
}

#[test]
fn a_frame_that_does_not_fit_is_refused_and_the_renderer_goes_on() {
    let [(device, queue), (other, _)] = two_devices();
    let mut renderer =
        ShadowVolumeRenderer::new(&device, &ShadowVolumeDescriptor::default()).unwrap();
    let good_view = view(DepthConvention::InfiniteReverse);
    let casters = cubes(&device, 2);
    let good = OneLight {
        range: Some(100.0),
        ..OneLight::new(&good_view, LIGHT, &casters)
    };
    let standard = view(DepthConvention::Standard);
    let changed = |transform| {
        let mut casters = casters.clone();
        casters[1].world_from_object = transform;
        casters
    };
    let nan = changed(Affine3A::from_scale(Vec3::splat(f32::NAN)));
    let foreign = vec![
        casters[0].clone(),
        Caster::new(cube(&other), Affine3A::IDENTITY),
    ];
    let of_maps = vec![
        casters[0].clone(),
        Caster::new(for_maps(&device), Affine3A::IDENTITY),
    ];
    let (inf, dark) = (f32::INFINITY, HomogeneousLight::directional(Vec3::ZERO));
    let cone = |direction, half_angle| {
        Some(VolumeCone {
            direction,
            half_angle,
        })
    };
    let bad = [
        (
            OneLight {
                view: &standard,
                ..good
            },
            Error::Depth {
                renderer: DepthConvention::InfiniteReverse,
                view: DepthConvention::Standard,
            },
        ),
        (
            OneLight {
                light: dark,
                ..good
            },
            LightError::Direction.into(),
        ),
        (
            OneLight {
                light: HomogeneousLight::point(Vec3::new(0.0, inf, 0.0)),
                ..good
            },
            LightError::Position([0.0, inf, 0.0]).into(),
        ),
        (
            OneLight {
                range: Some(0.0),
                ..good
            },
            LightError::Range(0.0).into(),
        ),
        (
            OneLight {
                range: Some(-1.0),
                ..good
            },
            LightError::Range(-1.0).into(),
        ),
        (
            OneLight {
                range: Some(inf),
                ..good
            },
            LightError::Range(inf).into(),
        ),
        (
            OneLight {
                cone: cone(Vec3::ZERO, 0.5),
                ..good
            },
            LightError::SpotDirection([0.0; 3]).into(),
        ),
        (
            OneLight {
                cone: cone(Vec3::new(0.0, inf, 0.0), 0.5),
                ..good
            },
            LightError::SpotDirection([0.0, inf, 0.0]).into(),
        ),
        (
            OneLight {
                cone: cone(Vec3::Y, 0.0),
                ..good
            },
            LightError::HalfAngle(0.0).into(),
        ),
        (
            OneLight {
                cone: cone(Vec3::Y, std::f32::consts::FRAC_PI_2),
                ..good
            },
            LightError::HalfAngle(std::f32::consts::FRAC_PI_2).into(),
        ),
        (
            OneLight {
                receivers: Some(Bounds {
                    min: Vec3::ONE,
                    max: Vec3::ZERO,
                }),
                ..good
            },
            Error::Receivers {
                min: [1.0; 3],
                max: [0.0; 3],
            },
        ),
        (
            OneLight {
                target_size: Some([640, 0]),
                ..good
            },
            Error::TargetSize([640, 0]),
        ),
        (
            OneLight {
                casters: &nan,
                ..good
            },
            CasterError::NotFinite { index: 1 }.into(),
        ),
        (
            OneLight {
                casters: &foreign,
                ..good
            },
            CasterError::Device { index: 1 }.into(),
        ),
        (
            OneLight {
                casters: &of_maps,
                ..good
            },
            Error::NoAdjacency { index: 1 },
        ),
    ];
    for (frame, error) in &bad {
        assert_eq!(
            renderer.prepare_one(&device, &queue, frame).as_ref(),
            Err(error)
        );
        assert_eq!(renderer.prepare_one(&device, &queue, &good), Ok(()));
        assert_eq!(renderer.statistics().casters_drawn, 2);
    }
    let frame = OneLight {
        range: Some(f32::NAN),
        ..good
    };
    let error = renderer.prepare_one(&device, &queue, &frame);
    assert!(
        matches!(error, Err(Error::Light(LightError::Range(_)))),
        "{error:?}"
    );
}

#[test]
fn more_casters_than_fit_are_refused() {
    let limits = wgpu::Limits {
        max_buffer_size: 4096,
        max_storage_buffer_binding_size: 4096,
        ..wgpu::Limits::defaults()
    };
    let (device, queue) = noop(FLOAT, limits);
    let mut renderer = ShadowVolumeRenderer::new(&device, &by_compute()).unwrap();
    let view = view(DepthConvention::InfiniteReverse);
    let casters = cubes(&device, 17);
    let frame = |count| OneLight::new(&view, LIGHT, &casters[..count]);
    assert_eq!(
        renderer.prepare_one(&device, &queue, &frame(17)),
        Err(Error::TooManyCasters {
            count: 17,
            limit: 16
        })
    );
    assert_eq!(renderer.prepare_one(&device, &queue, &frame(16)), Ok(()));
    // 16 instances of 12 triangles: caps need 2304 bytes, all in one chunk.
    // And their draws, all in one chunk, too.
    assert_eq!(renderer.statistics().dispatches, 3);
}

#[test]
fn a_batch_is_split_where_a_buffer_would_be_too_large() {
    let limits = wgpu::Limits {
        max_buffer_size: 65_536,
        max_storage_buffer_binding_size: 2_816,
        ..wgpu::Limits::defaults()
    };
    let (device, queue) = noop(FLOAT, limits);
    let mut renderer = ShadowVolumeRenderer::new(&device, &by_compute()).unwrap();
    let mut casters = cubes(&device, 16);
    let sphere = shapes::sphere(3);
    let adjacency = Adjacency::new(&sphere.positions, &sphere.indices).unwrap();
    let mesh = CasterMesh::new(&device, &sphere.positions, &adjacency).unwrap();
    (casters.iter_mut()).for_each(|caster| caster.mesh = mesh.clone());
    let view = view(DepthConvention::InfiniteReverse);
    let frame = OneLight::new(&view, LIGHT, &casters);
    renderer.prepare_one(&device, &queue, &frame).unwrap();
    let statistics = renderer.statistics();
    // 176 bytes of parameters each, of which 16 just fit. 288 bytes of caps: nine to a chunk, so two
    // chunks, two passes each. Their draws lie in one.
    assert_eq!(statistics.dispatches, 4 + 1);
    assert_eq!(statistics.casters_drawn, 16);
    assert_eq!(statistics.triangles, 16 * 24);
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    renderer.encode(&mut device.create_command_encoder(&Default::default()));
    assert!(pollster::block_on(scope.pop()).is_none());
}

#[test]
fn casters_out_of_range_cost_nothing() {
    let (device, queue) = bare();
    let descriptor = ShadowVolumeDescriptor {
        method: Method::ZFail,
        ..Default::default()
    };
    let mut renderer = ShadowVolumeRenderer::new(&device, &descriptor).unwrap();
    let view = view(DepthConvention::InfiniteReverse);
    let casters = cubes(&device, 3);
    let mut frame = OneLight {
        range: Some(3.9),
        ..OneLight::new(&view, HomogeneousLight::point(Vec3::ZERO), &casters)
    };
    renderer.prepare_one(&device, &queue, &frame).unwrap();
    let none = renderer.statistics();
    assert_eq!((none.casters_drawn, none.casters_skipped), (0, 3));
    assert_eq!(none.skipped_out_of_range, 3);
    assert_eq!((none.draws, none.dispatches, none.gpu_bytes), (0, 0, 0));
    // The nearest points of the boxes are 4, 7 and 10 away.
    for (range, drawn) in [(4.0, 1), (6.9, 1), (7.0, 2), (10.0, 3)] {
        frame.range = Some(range);
        renderer.prepare_one(&device, &queue, &frame).unwrap();
        assert_eq!(renderer.statistics().casters_drawn, drawn, "range {range}");
    }
    frame.range = Some(3.9);
    frame.light = HomogeneousLight::directional(Vec3::Y);
    renderer.prepare_one(&device, &queue, &frame).unwrap();
    assert_eq!(renderer.statistics().casters_drawn, 3);
    // Sides and light caps, no dark caps: nothing of them is left at infinity. All three share their draws.
    assert_eq!(renderer.statistics().draws, 2);
}
