//! What is refused.

use shadows::error::{BlobShadowError, CasterError, LightError};
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Blob, BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor,
    HomogeneousLight, wgpu,
};

use super::calls::{depth, row, sun, with_decals};
use crate::common::shapes::cuboid;
use crate::common::{noop, noop_with, two_noop_devices};
use host::renderer::{Look, view_as};
use host::scene::floor;

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
        // They blend, if they could be drawn into.
        wgpu::TextureFormat::Rgba8Snorm,
        wgpu::TextureFormat::Rgb9e5Ufloat,
    ] {
        let expected = BlobShadowError::TargetFormat(format);
        assert_eq!(refused(&target(format)), expected);
    }
    let by_adapter = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let (own_formats, _) = noop_with(by_adapter, wgpu::Limits::defaults());
    let whole = wgpu::TextureFormat::R32Uint;
    let error = BlobShadow::new(&own_formats, &target(whole)).map(|_| ());
    assert_eq!(error.unwrap_err(), BlobShadowError::TargetFormat(whole));
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
fn receivers_read_as_many_lights_as_one_binding_holds() {
    let limits = wgpu::Limits {
        max_uniform_buffer_binding_size: 16 << 10,
        ..wgpu::Limits::defaults()
    };
    let (device, _) = noop_with(wgpu::Features::empty(), limits);
    let new = |lights, receivers| {
        let descriptor = BlobShadowDescriptor {
            lights,
            receivers,
            ..with_decals()
        };
        BlobShadow::new(&device, &descriptor).map(|_| ())
    };
    assert_eq!(new(64, true), Ok(()));
    let expected = BlobShadowError::Range {
        what: "lights",
        value: 65,
        limit: 64,
    };
    assert_eq!(new(65, true), Err(expected));
    assert_eq!(new(256, false), Ok(()), "decals read one of them");
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
