//! What is uploaded, and what is refused.

use shadows::error::{BlobRenderError, BlobShadowError, CasterError, LightError};
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Blob, BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor,
    DirectionalLight, HomogeneousLight, wgpu,
};

use crate::common::shapes::{cuboid, sphere, square};
use crate::common::{noop, noop_with, two_noop_devices};
use host::gpu::Gpu;
use host::renderer::{Look, view_as};
use host::scene::floor;

fn sun() -> BlobLight {
    BlobLight::new(DirectionalLight::new(Vec3::Y), 0.1, 10.0)
}

fn with_decals() -> BlobShadowDescriptor<'static> {
    BlobShadowDescriptor {
        decals: Some(BlobDecalDescriptor::default()),
        ..Default::default()
    }
}

fn row(count: usize) -> Vec<Blob> {
    let at = |i: usize| Blob::sphere(Vec3::X * i as f32, 0.4);
    (0..count).map(at).collect()
}

#[test]
fn only_what_changed_is_uploaded() {
    let (device, queue) = noop();
    let mut shadow = BlobShadow::new(&device, &with_decals()).unwrap();
    let mut prepare = |blobs: &[Blob], light: BlobLight, encode: bool| {
        let frame = BlobFrame {
            lights: &[light],
            blobs,
            ..Default::default()
        };
        shadow.prepare(&device, &queue, &frame).unwrap();
        if encode {
            let mut encoder = device.create_command_encoder(&Default::default());
            shadow.encode(&mut encoder);
            queue.submit([encoder.finish()]);
        }
        shadow.statistics()
    };
    let mut blobs = row(50);
    let first = prepare(&blobs, sun(), true);
    assert_eq!((first.blobs, first.changed), (50, 50));
    assert_eq!(first.uploaded, 50 * 64 + 16 + 256);
    let second = prepare(&blobs, sun(), true);
    assert_eq!((second.changed, second.uploaded), (0, 0));
    blobs[7].centre.y = 1.0;
    assert_eq!(prepare(&blobs, sun(), true).uploaded, 64);
    // Two that are near each other in one piece.
    blobs[7].centre.y = 2.0;
    blobs[9].opacity = 0.5;
    let few = prepare(&blobs, sun(), true);
    assert_eq!((few.changed, few.uploaded), (2, 3 * 64));
    let moved = BlobLight {
        radius: 0.2,
        ..sun()
    };
    assert_eq!(prepare(&blobs, moved, true).uploaded, 256);
    // More than there is room for: all of them, into a buffer of its own.
    let more = prepare(&row(200), moved, true);
    assert_eq!(more.uploaded, 200 * 64 + 16);
    assert_eq!(prepare(&row(199), moved, true).uploaded, 16);
    assert_eq!(prepare(&row(200), moved, true).uploaded, 64 + 16);
    // What was not encoded is not lost.
    assert!(prepare(&row(1), moved, false).uploaded > 0);
    let again = prepare(&row(1), moved, true);
    assert!(again.not_encoded && again.uploaded == 64 + 16 + 256);
    assert!(!prepare(&row(1), moved, true).not_encoded);
    let flat = Blob::sphere(Vec3::ZERO, 0.0);
    assert_eq!(prepare(&[flat, row(1)[0]], moved, true).without_shadow, 1);
}

#[test]
fn an_encoder_that_is_dropped_is_no_upload() {
    let (device, queue) = noop();
    let mut shadow = BlobShadow::new(&device, &with_decals()).unwrap();
    let blobs = row(3);
    let frame = BlobFrame {
        lights: &[sun()],
        blobs: &blobs,
        ..Default::default()
    };
    shadow.prepare(&device, &queue, &frame).unwrap();
    let mut encoder = device.create_command_encoder(&Default::default());
    shadow.encode(&mut encoder);
    drop(encoder);
    shadow.prepare(&device, &queue, &frame).unwrap();
    let statistics = shadow.statistics();
    assert!(statistics.encoder_dropped && statistics.uploaded == 3 * 64 + 16 + 256);
}

#[test]
fn a_caster_is_an_ellipsoid_of_its_bounds() {
    let (device, _) = noop();
    let transform = Affine3A::from_translation(Vec3::Y * 3.0);
    let widths = |caster| {
        let blob = Blob::of_caster(&caster);
        assert_eq!(blob.centre, Vec3::Y * 3.0);
        blob.axes
    };
    let half = Vec3::new(1.0, 2.0, 3.0);
    let [x, y, z] = widths(cuboid(half).caster(&device, transform));
    // Of the box's volume if it is as thick as wide, of a plate's area.
    let flat = 2.0 / std::f32::consts::PI.sqrt();
    let wider = 0.5 * (flat + (6.0 / std::f32::consts::PI).cbrt());
    for (axis, expected) in [
        (x, Vec3::X * wider),
        (y, Vec3::Y * 2.0 * wider),
        (z, Vec3::Z * 3.0 * wider),
    ] {
        assert!((axis - expected).length() < 1e-6, "{axis}");
    }
    let stretched = transform * Affine3A::from_scale(half);
    let [x, _, z] = widths(sphere(31, 64).caster(&device, stretched));
    assert!((x - Vec3::X).length() < 1e-5 && (z - Vec3::Z * 3.0).length() < 1e-5);
    let [x, y, _] = widths(square(1.0).caster(&device, transform));
    assert!(y == Vec3::ZERO && (x - Vec3::X * flat).length() < 1e-6);
}

#[test]
fn descriptors_out_of_range_are_refused() {
    let (device, _) = noop();
    let refused = |descriptor: &BlobShadowDescriptor<'_>| {
        BlobShadow::new(&device, descriptor)
            .map(|_| ())
            .unwrap_err()
    };
    for value in [0, 257] {
        let lights = BlobShadowDescriptor {
            lights: value,
            ..Default::default()
        };
        let views = BlobShadowDescriptor {
            views: value,
            ..Default::default()
        };
        let strips = BlobShadowDescriptor {
            strips: value,
            ..Default::default()
        };
        for (what, descriptor, limit) in [
            ("lights", lights, 256),
            ("views", views, 256),
            ("strips", strips, 64),
        ] {
            let expected = BlobShadowError::Range { what, value, limit };
            assert_eq!(refused(&descriptor), expected);
        }
    }
    let target = |target_format| BlobShadowDescriptor {
        decals: Some(BlobDecalDescriptor {
            target_format,
            ..Default::default()
        }),
        ..Default::default()
    };
    for format in [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::R32Uint,
        wgpu::TextureFormat::Bc1RgbaUnorm,
    ] {
        let expected = BlobShadowError::TargetFormat(format);
        assert_eq!(refused(&target(format)), expected);
    }
    let color = wgpu::TextureFormat::R8Unorm;
    let descriptor = BlobShadowDescriptor {
        decals: Some(BlobDecalDescriptor {
            depth_stencil_format: Some(color),
            ..Default::default()
        }),
        ..Default::default()
    };
    assert_eq!(refused(&descriptor), BlobShadowError::DepthFormat(color));
    let limits = wgpu::Limits::downlevel_webgl2_defaults();
    let (device, _) = noop_with(wgpu::Features::empty(), limits);
    let error = BlobShadow::new(&device, &with_decals()).map(|_| ());
    assert_eq!(error.unwrap_err(), BlobShadowError::NoStorage);
    // Decals need none.
    let decals_only = BlobShadowDescriptor {
        receivers: false,
        ..with_decals()
    };
    let shadow = BlobShadow::new(&device, &decals_only).unwrap();
    assert!(shadow.bind_group().is_none() && shadow.bind_group_layout().is_none());
}

#[test]
fn frames_out_of_range_are_refused_and_leave_what_was() {
    let [(device, queue), (other, _)] = two_noop_devices();
    let mut shadow = BlobShadow::new(&device, &with_decals()).unwrap();
    let view = view_as(&floor(), [64, 64], Look::default()).unwrap();
    let mut prepare = |frame: BlobFrame<'_>| {
        let result = shadow.prepare(&device, &queue, &frame);
        (result, shadow.statistics())
    };
    let blobs = row(3);
    let good = BlobFrame {
        lights: &[sun()],
        blobs: &blobs,
        ..Default::default()
    };
    assert_eq!(prepare(good).1.blobs, 3);
    let nan = f32::NAN;
    let caster = cuboid(Vec3::ONE).caster(&device, Affine3A::IDENTITY);
    let mut wrong = caster.clone();
    wrong.world_from_object.translation.x = nan;
    let foreign = cuboid(Vec3::ONE).caster(&other, Affine3A::IDENTITY);
    let of_lights = |lights| BlobFrame { lights, ..good };
    let of_blobs = |blobs| BlobFrame { blobs, ..good };
    let bad = BlobLight {
        light: HomogeneousLight::directional(Vec3::ZERO),
        ..sun()
    };
    use BlobShadowError as E;
    for (frame, expected) in [
        (
            of_lights(&[sun(), sun()]),
            E::TooMany {
                what: "lights",
                count: 2,
                limit: 1,
            },
        ),
        (
            BlobFrame {
                views: &[view, view],
                ..good
            },
            E::TooMany {
                what: "views",
                count: 2,
                limit: 1,
            },
        ),
        (
            of_lights(&[bad]),
            E::Light {
                index: 0,
                error: LightError::Direction,
            },
        ),
        (
            of_lights(&[BlobLight {
                radius: -1.0,
                ..sun()
            }]),
            E::Radius {
                index: 0,
                radius: -1.0,
            },
        ),
        (
            of_lights(&[BlobLight {
                reach: 0.0,
                ..sun()
            }]),
            E::Reach {
                index: 0,
                reach: 0.0,
            },
        ),
        (
            of_blobs(&[blobs[0], Blob::sphere(Vec3::ONE, nan)]),
            E::Blob { index: 1 },
        ),
        (
            of_blobs(&[Blob {
                opacity: 1.5,
                ..blobs[0]
            }]),
            E::Opacity {
                index: 0,
                opacity: 1.5,
            },
        ),
        (
            BlobFrame {
                casters: &[caster.clone(), wrong],
                ..good
            },
            E::Caster(CasterError::NotFinite { index: 1 }),
        ),
        (
            BlobFrame {
                casters: &[foreign],
                ..good
            },
            E::Caster(CasterError::Device { index: 0 }),
        ),
    ] {
        let (result, statistics) = prepare(frame);
        assert_eq!(result, Err(expected));
        assert_eq!(statistics.blobs, 3);
    }
    for light in [
        bad,
        BlobLight {
            radius: nan,
            ..sun()
        },
    ] {
        assert!(light.validate().is_err());
    }
    let both = BlobFrame {
        casters: &[caster],
        ..good
    };
    assert_eq!(prepare(both).1.blobs, 4);
}

#[test]
fn more_blobs_than_buffers_hold_are_refused() {
    let limits = wgpu::Limits {
        max_buffer_size: 1 << 16,
        ..wgpu::Limits::defaults()
    };
    let (device, queue) = noop_with(wgpu::Features::empty(), limits);
    let mut shadow = BlobShadow::new(&device, &with_decals()).unwrap();
    let mut prepare = |count| {
        let frame = BlobFrame {
            lights: &[sun()],
            blobs: &row(count),
            ..Default::default()
        };
        shadow.prepare(&device, &queue, &frame)
    };
    assert_eq!(prepare(1023), Ok(()));
    let expected = BlobShadowError::TooManyBlobs {
        count: 1024,
        limit: 1023,
    };
    assert_eq!(prepare(1024), Err(expected));
}

/// A depth texture of one layer.
fn depth(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
    [samples, layers]: [u32; 2],
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: 16,
            height: 16,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

#[test]
fn depth_that_cannot_be_read_is_refused() {
    let (device, _) = noop();
    let shadow = BlobShadow::new(&device, &with_decals()).unwrap();
    use wgpu::{TextureFormat as F, TextureUsages as U};
    let bind = U::TEXTURE_BINDING;
    for format in [F::Depth32Float, F::Depth24PlusStencil8, F::Depth16Unorm] {
        let view = depth(&device, format, bind, [1, 1]);
        shadow.decal_bind_group(&device, &view).unwrap();
    }
    for (format, usage, sizes) in [
        (F::R8Unorm, bind, [1, 1]),
        (F::Depth32Float, U::empty(), [1, 1]),
        (F::Depth32Float, bind, [4, 1]),
        (F::Depth32Float, bind, [1, 2]),
    ] {
        let view = depth(&device, format, usage, sizes);
        let error = shadow.decal_bind_group(&device, &view).unwrap_err();
        let [samples, layers] = sizes;
        let usage = usage | U::RENDER_ATTACHMENT;
        let expected = BlobShadowError::Depth {
            format,
            usage,
            samples,
            layers,
        };
        assert_eq!(error, expected);
    }
    let plain = BlobShadow::new(&device, &Default::default()).unwrap();
    let view = depth(&device, F::Depth32Float, bind, [1, 1]);
    let error = plain.decal_bind_group(&device, &view).unwrap_err();
    assert_eq!(error, BlobShadowError::NoDecals);
}

#[test]
fn nothing_is_drawn_before_it_is_encoded_nor_what_the_frame_has_not() {
    let Some(gpu) = Gpu::for_test() else { return };
    let device = &gpu.device;
    let mut shadow = BlobShadow::new(device, &with_decals()).unwrap();
    let plain = BlobShadow::new(device, &Default::default()).unwrap();
    let format = wgpu::TextureFormat::Depth32Float;
    let view = depth(device, format, wgpu::TextureUsages::TEXTURE_BINDING, [1, 1]);
    let group = shadow.decal_bind_group(device, &view).unwrap();
    let target = gpu.target([16, 16], wgpu::TextureFormat::R8Unorm, 1);
    let target = target.create_view(&Default::default());
    let render = |shadow: &BlobShadow, light, view| {
        let mut result = Ok(());
        gpu.run(|encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Default::default(),
                })],
                ..Default::default()
            });
            result = shadow.render(&mut pass, light, view, &group);
        });
        result
    };
    assert_eq!(render(&plain, 0, 0), Err(BlobRenderError::NoDecals));
    let view = view_as(&floor(), [64, 64], Look::default()).unwrap();
    let blobs = row(3);
    let frame = BlobFrame {
        lights: &[sun()],
        views: &[view],
        blobs: &blobs,
        ..Default::default()
    };
    shadow.prepare(device, &gpu.queue, &frame).unwrap();
    assert_eq!(render(&shadow, 0, 0), Err(BlobRenderError::NotEncoded));
    let mut encoder = device.create_command_encoder(&Default::default());
    shadow.encode(&mut encoder);
    drop(encoder);
    assert_eq!(render(&shadow, 0, 0), Err(BlobRenderError::Dropped));
    shadow.prepare(device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| shadow.encode(encoder));
    assert_eq!(render(&shadow, 0, 0), Ok(()));
    for (light, view) in [(1, 0), (0, 1)] {
        let expected = BlobRenderError::NoSuch {
            light,
            view,
            lights: 1,
            views: 1,
        };
        assert_eq!(render(&shadow, light, view), Err(expected));
    }
}
