//! What is uploaded and drawn from call to call.

use shadows::error::BlobRenderError;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Blob, BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor, Caster,
    DirectionalLight, wgpu,
};

use super::ask::{Question, answers_from};
use crate::common::noop;
use crate::common::shapes::{cuboid, sphere, square};
use host::gpu::Gpu;
use host::renderer::{Look, view_as};
use host::scene::floor;

pub fn sun() -> BlobLight {
    BlobLight::new(DirectionalLight::new(Vec3::Y), 0.1, 10.0)
}

pub fn with_decals() -> BlobShadowDescriptor<'static> {
    BlobShadowDescriptor {
        decals: Some(BlobDecalDescriptor::default()),
        ..Default::default()
    }
}

pub fn row(count: usize) -> Vec<Blob> {
    let at = |i: usize| Blob::sphere(Vec3::X * i as f32, 0.4);
    (0..count).map(at).collect()
}

/// A depth texture of one layer.
pub fn depth(
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
fn what_is_beyond_f32_casts_nothing() {
    let (device, queue) = noop();
    let mut shadow = BlobShadow::new(&device, &with_decals()).unwrap();
    // A plate that lies aside of its mesh's origin, farther than f32 reaches.
    let mut plate = square(1.0);
    plate.positions.iter_mut().for_each(|[_, y, _]| *y = 3.0);
    let away = Affine3A::from_scale(Vec3::new(1.0, 1.2e38, 1.0));
    let casters = [
        plate.caster(&device, away),
        plate.caster(&device, Affine3A::IDENTITY),
    ];
    assert!(!Blob::of_caster(&casters[0]).centre.is_finite());
    let frame = BlobFrame {
        lights: &[sun()],
        casters: &casters,
        // The second is as large as what casts may be, the third larger.
        blobs: &[
            Blob::sphere(Vec3::ZERO, 1.0),
            Blob::sphere(Vec3::ZERO, 9e15),
            Blob::sphere(Vec3::ZERO, 2e16),
        ],
        ..Default::default()
    };
    shadow.prepare(&device, &queue, &frame).unwrap();
    let found = shadow.statistics();
    assert_eq!((found.blobs, found.without_shadow), (5, 2));
}

#[test]
fn casters_come_go_and_move_before_blobs_that_stay() {
    let Some(gpu) = Gpu::for_test() else { return };
    let cube = cuboid(Vec3::splat(0.4));
    let mesh = cube.mesh(&gpu.device);
    let at = |x: f32, z: f32| {
        let place = Affine3A::from_translation(Vec3::new(x, 1.0, z));
        Caster::new(mesh.clone(), place)
    };
    let blobs = [1.0, 3.0].map(|x| Blob::sphere(Vec3::new(x, 1.0, -3.0), 0.5));
    let flat = Blob::sphere(Vec3::Y, 0.0);
    let below = (0..14 * 9).map(|i| Vec3::new((i % 14) as f32 - 2.0, 0.0, (i / 14) as f32 - 4.0));
    let questions: Vec<Question> = below.map(|at| Question::of(at, 0)).collect();
    let new = || BlobShadow::new(&gpu.device, &Default::default()).unwrap();
    let mut kept = new();
    let mut step = |casters: &[Caster], blobs: &[Blob], encode: bool| {
        let frame = BlobFrame {
            lights: &[sun()],
            casters,
            blobs,
            ..Default::default()
        };
        kept.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        let found = kept.statistics();
        if encode {
            gpu.run(|encoder| kept.encode(encoder));
            let mut fresh = new();
            fresh.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
            gpu.run(|encoder| fresh.encode(encoder));
            let [ours, theirs] =
                [&kept, &fresh].map(|shadow| answers_from(&gpu, shadow, &questions, |text| text));
            assert_eq!(ours, theirs);
            let dark = ours.iter().filter(|v| **v < 0.5).count();
            let without = found.without_shadow as usize;
            assert_eq!(dark, casters.len() + blobs.len() - without);
            assert_eq!(found.without_shadow, fresh.statistics().without_shadow);
        }
        (found.changed, found.uploaded)
    };
    let mut casters = vec![at(0.0, 0.0), at(2.0, 0.0), at(4.0, 0.0)];
    assert_eq!(step(&casters, &blobs, true), (5, 5 * 64 + 16 + 256));
    assert_eq!(step(&casters, &blobs, true), (0, 0));
    casters[1] = at(2.0, 2.0);
    assert_eq!(step(&casters, &blobs, true), (1, 64));
    // What does not change an ellipsoid.
    casters[2].layers = 1;
    mesh.bump_revision();
    assert_eq!(step(&casters, &blobs, true), (0, 0));
    // One goes: all behind it are in other places; one more comes, before the same blobs.
    casters.remove(0);
    assert_eq!(step(&casters, &blobs, true), (4, 4 * 64 + 16));
    casters.push(at(6.0, 1.0));
    assert_eq!(step(&casters, &blobs, true), (3, 3 * 64 + 16));
    casters.swap(0, 2);
    assert_eq!(step(&casters, &blobs, true).0, 2);
    // More than there was room for, and none.
    let many: Vec<_> = (0..70)
        .map(|i| at((i % 11) as f32, (i / 11) as f32 - 2.0))
        .collect();
    assert_eq!(step(&many, &blobs, true), (72, 72 * 64 + 16));
    assert_eq!(step(&[], &blobs, true).0, 2);
    assert_eq!(step(&casters, &[flat, blobs[0]], true).0, 5);
    // What changed in a frame that was not encoded is not lost in the next.
    casters[0] = at(8.0, 3.0);
    step(&casters, &blobs, false);
    assert_eq!(step(&casters, &blobs, true), (0, 5 * 64 + 16 + 256));
    assert_eq!(step(&casters[..1], &[], true).0, 0);
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
    assert_eq!(render(&shadow, 0, 0), Err(BlobRenderError::NotEncoded));
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
    // What the host declares lost is not drawn before it is prepared and encoded again.
    shadow.invalidate();
    gpu.run(|encoder| shadow.encode(encoder));
    assert_eq!(render(&shadow, 0, 0), Err(BlobRenderError::NotEncoded));
    shadow.prepare(device, &gpu.queue, &frame).unwrap();
    gpu.run(|encoder| shadow.encode(encoder));
    assert_eq!(render(&shadow, 0, 0), Ok(()));
}
