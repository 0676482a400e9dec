//! Bad input to `CubeShadowMap`: a typed error that names it, and the map usable afterwards.

use crate::common::shapes::cuboid;
use crate::common::{noop, noop_with, two_noop_devices};
use glam::{Affine3A, Vec3};
use shadows::error::{CasterError, CubeShadowMapError, LightError};
use shadows::{
    Bias, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, MapSettings,
    PointLight, StaticLayers, glam, wgpu,
};

fn descriptor(size: u32) -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size,
        ..Default::default()
    }
}

#[test]
fn sizes_out_of_range_are_refused() {
    let (device, _) = noop();
    for size in [0, 8193, u32::MAX] {
        let error = CubeShadowMap::new(&device, &descriptor(size)).unwrap_err();
        assert_eq!(error, CubeShadowMapError::Size { size, limit: 8192 });
    }
    CubeShadowMap::new(&device, &descriptor(1)).unwrap();
    CubeShadowMap::new(&device, &descriptor(8192)).unwrap();
}

#[test]
fn bad_frames_are_refused_and_the_map_goes_on() {
    let [(device, queue), (other_device, _)] = two_noop_devices();
    let mut map = CubeShadowMap::new(&device, &descriptor(64)).unwrap();
    let light = PointLight::new(Vec3::ZERO, 10.0);
    let good = [cuboid(Vec3::ONE).caster(&device, Affine3A::from_translation(Vec3::X * 4.0))];
    let frame = CubeFrame::new(light, &good);
    map.prepare(&device, &queue, &frame).unwrap();
    let before = map.statistics();

    let mut refused = |light| {
        let frame = CubeFrame { light, ..frame };
        match map.prepare(&device, &queue, &frame).unwrap_err() {
            CubeShadowMapError::Light(error) => error,
            other => panic!("{other}"),
        }
    };
    for range in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
        let error = refused(PointLight { range, ..light });
        assert!(matches!(error, LightError::Range(_)), "{error}");
    }
    for near in [f32::NAN, 0.0, 10.0, 11.0, 1e-38] {
        let near = Some(near);
        let error = refused(PointLight { near, ..light });
        assert!(matches!(error, LightError::Near { .. }), "{error}");
    }
    let position = Vec3::NAN;
    let error = refused(PointLight { position, ..light });
    assert!(matches!(error, LightError::Position(_)), "{error}");

    let bent = Caster::new(
        good[0].mesh.clone(),
        Affine3A::from_translation(Vec3::splat(f32::NAN)),
    );
    let foreign = cuboid(Vec3::ONE).caster(&other_device, Affine3A::IDENTITY);
    for (caster, expected) in [
        (bent, CasterError::NotFinite { index: 1 }),
        (foreign, CasterError::Device { index: 1 }),
    ] {
        let casters = [good[0].clone(), caster];
        let error = map
            .prepare(
                &device,
                &queue,
                &CubeFrame {
                    casters: &casters,
                    ..frame
                },
            )
            .unwrap_err();
        assert_eq!(error, CubeShadowMapError::Caster(expected));
    }
    assert_eq!(map.statistics(), before, "a refused frame changes nothing");
    map.prepare(&device, &queue, &frame).unwrap();
    let mut encoder = device.create_command_encoder(&Default::default());
    map.encode(&mut encoder);
    queue.submit([encoder.finish()]);
}

/// A device whose buffers hold 4096 bytes.
fn small_buffers() -> (wgpu::Device, wgpu::Queue) {
    let limits = wgpu::Limits {
        max_buffer_size: 4096,
        max_storage_buffer_binding_size: 4096,
        max_uniform_buffer_binding_size: 4096,
        ..wgpu::Limits::defaults()
    };
    noop_with(wgpu::Features::empty(), limits)
}

#[test]
fn more_casters_than_a_buffer_holds_are_refused() {
    let (device, queue) = small_buffers();
    let mut map = CubeShadowMap::new(&device, &descriptor(64)).unwrap();
    let light = PointLight::new(Vec3::ZERO, 10.0);
    let one = cuboid(Vec3::splat(0.1)).caster(&device, Affine3A::from_translation(Vec3::X * 4.0));
    let casters = vec![one; 86];
    let of = |count: usize| CubeFrame::new(light, &casters[..count]);
    let encode = |map: &mut CubeShadowMap| {
        let mut encoder = device.create_command_encoder(&Default::default());
        map.encode(&mut encoder);
        queue.submit([encoder.finish()]);
    };
    map.prepare(&device, &queue, &of(85)).unwrap();
    encode(&mut map);
    let before = map.statistics();
    let error = map.prepare(&device, &queue, &of(86)).unwrap_err();
    assert_eq!(
        error,
        CubeShadowMapError::TooManyCasters {
            instances: 86,
            size: 86 * 48,
            limit: 4096
        }
    );
    // What was drawn before still stands, and is known to.
    assert_eq!(map.statistics(), before);
    encode(&mut map);
    map.prepare(&device, &queue, &of(85)).unwrap();
    let after = map.statistics();
    assert_eq!((before.faces_rendered, after.faces_rendered), (6, 0));
    map.prepare(&device, &queue, &of(84)).unwrap();
    assert_eq!(map.statistics().faces_rendered, 1);
}

#[test]
fn a_slope_scaled_bias_of_distances_is_refused() {
    let (device, _) = noop();
    let good = descriptor(64);
    let refused = |descriptor| CubeShadowMap::new(&device, &descriptor).unwrap_err();
    let sloped = CubeShadowMapDescriptor {
        settings: MapSettings {
            bias: Bias {
                slope_scale: 1.0,
                ..Bias::default()
            },
            ..Default::default()
        },
        encoding: DepthEncoding::LinearDistance,
        ..good.clone()
    };
    assert_eq!(refused(sloped), CubeShadowMapError::SlopeScale);
    CubeShadowMap::new(&device, &good).unwrap();
}

#[test]
fn layers_of_still_casters_are_refused_where_there_are_none() {
    let (device, _) = noop();
    let new = |static_layers, cache| {
        let descriptor = CubeShadowMapDescriptor {
            static_layers,
            cache,
            ..descriptor(64)
        };
        CubeShadowMap::new(&device, &descriptor).map(drop)
    };
    let at_least = new(StaticLayers::AtLeast(1), false);
    assert_eq!(at_least, Err(CubeShadowMapError::NoStaticLayers));
    // What the message tells to pass.
    for layers in [StaticLayers::Auto, StaticLayers::Never] {
        assert_eq!(new(layers, false), Ok(()), "{layers:?}");
    }
    let effective = new(StaticLayers::AtLeast(1), true);
    assert_eq!(effective, Ok(()), "the broken twin: a map that has layers");
}
