//! What a flat map refuses, and that it works on afterwards.

use crate::common::shapes::square;
use crate::common::{noop, two_noop_devices};
use glam::{Affine3A, Mat4, Vec3};
use shadows::error::{CasterError, LightError, PcfError, ShadowMapError};
use shadows::mesh::Bounds;
use shadows::{
    CubeShadowMap, CubeShadowMapDescriptor, DepthConvention, DirectionalLight, FlatLight, MapKind,
    MapSettings, PcfDescriptor, PcfSampler, Radius, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    SpotLight, View, glam, wgpu,
};

fn sun() -> FlatLight {
    FlatLight::Directional(DirectionalLight::new(Vec3::Y))
}

fn new(descriptor: &ShadowMapDescriptor<'_>) -> Result<ShadowMap, ShadowMapError> {
    ShadowMap::new(&noop().0, descriptor)
}

#[test]
fn sizes_out_of_range_are_refused() {
    for size in [0, 8193] {
        let descriptor = ShadowMapDescriptor {
            size,
            ..Default::default()
        };
        let expected = ShadowMapError::Size { size, limit: 8192 };
        assert_eq!(new(&descriptor).unwrap_err(), expected);
    }
}

#[test]
fn a_directional_light_needs_a_map_with_texels_to_spare_for_its_kernels() {
    let (device, queue) = noop();
    let casters = [square(1.0).caster(&device, Affine3A::IDENTITY)];
    let prepared = |size, reach, light| {
        let descriptor = ShadowMapDescriptor {
            size,
            settings: MapSettings {
                reach,
                ..Default::default()
            },
            ..Default::default()
        };
        let mut map = ShadowMap::new(&device, &descriptor).unwrap();
        map.prepare(&device, &queue, &ShadowFrame::new(light, &casters))
    };
    let refused = ShadowMapError::ReachOfSize {
        reach: 12.0,
        size: 51,
    };
    assert!(refused.to_string().contains("at least 52"));
    assert_eq!(prepared(51, Radius::Texels(12.0), sun()), Err(refused));
    assert_eq!(prepared(52, Radius::Texels(12.0), sun()), Ok(()));
    // In world units, too: such a map holds the usual kernels as well.
    assert!(prepared(51, Radius::World(1e-3), sun()).is_err());
    // A spot's map is its cone.
    let spot = SpotLight::new(Vec3::Y, Vec3::NEG_Y, 0.5, 9.0);
    assert_eq!(prepared(1, Radius::Texels(64.0), spot.into()), Ok(()));
}

#[test]
fn a_bad_frame_is_refused_and_the_map_works_on() {
    let [(device, queue), (other, _)] = two_noop_devices();
    let mut map = ShadowMap::new(&device, &ShadowMapDescriptor::default()).unwrap();
    let casters = [square(1.0).caster(&device, Affine3A::IDENTITY)];
    let frame = ShadowFrame::new(sun(), &casters);
    let mut refused = |frame: &ShadowFrame<'_>| map.prepare(&device, &queue, frame).unwrap_err();

    let light = FlatLight::Directional(DirectionalLight::new(Vec3::ZERO));
    let error = refused(&ShadowFrame { light, ..frame });
    assert_eq!(error, ShadowMapError::Light(LightError::Direction));

    let foreign = [square(1.0).caster(&other, Affine3A::IDENTITY)];
    let error = refused(&ShadowFrame::new(sun(), &foreign));
    let expected = CasterError::Device { index: 0 };
    assert_eq!(error, ShadowMapError::Caster(expected));

    let projection = glam::camera::rh::proj::directx::perspective_infinite_reverse(0.8, 1.5, 0.1);
    let view = View::new(
        projection * Mat4::IDENTITY,
        DepthConvention::InfiniteReverse,
    )
    .unwrap();
    for distance in [0.0, -1.0, f32::INFINITY] {
        let view = Some((&view, distance));
        let error = refused(&ShadowFrame { view, ..frame });
        assert_eq!(error, ShadowMapError::Distance(distance));
    }
    let receivers = Some(Bounds {
        min: Vec3::ONE,
        max: Vec3::ZERO,
    });
    let error = refused(&ShadowFrame { receivers, ..frame });
    let (min, max) = ([1.0; 3], [0.0; 3]);
    assert_eq!(error, ShadowMapError::Receivers { min, max });

    map.prepare(&device, &queue, &frame).unwrap();
    assert_eq!(map.statistics().casters_drawn, 1);
}

#[test]
fn more_casters_than_a_buffer_holds_are_refused() {
    let limits = wgpu::Limits {
        max_buffer_size: 4096,
        max_uniform_buffer_binding_size: 4096,
        max_storage_buffer_binding_size: 4096,
        ..wgpu::Limits::defaults()
    };
    let (device, queue) = crate::common::noop_with(wgpu::Features::empty(), limits);
    let mut map = ShadowMap::new(&device, &ShadowMapDescriptor::default()).unwrap();
    let casters = vec![square(1.0).caster(&device, Affine3A::IDENTITY); 100];
    let error = map
        .prepare(&device, &queue, &ShadowFrame::new(sun(), &casters))
        .unwrap_err();
    let expected = ShadowMapError::TooManyCasters {
        casters: 100,
        size: 4800,
        limit: 4096,
    };
    assert_eq!(error, expected);
    map.prepare(&device, &queue, &ShadowFrame::new(sun(), &casters[..50]))
        .unwrap();
}

#[test]
fn a_sampler_refuses_the_other_kind_of_map() {
    let (device, queue) = noop();
    let flat = ShadowMap::new(&device, &ShadowMapDescriptor::default()).unwrap();
    let cube = CubeShadowMap::new(&device, &CubeShadowMapDescriptor::default()).unwrap();
    let sampler = |map| {
        let descriptor = PcfDescriptor {
            map,
            ..Default::default()
        };
        PcfSampler::new(&device, &queue, &descriptor).unwrap()
    };
    let for_cubes = sampler(MapKind::CUBE);
    let expected = PcfError::Map {
        made_for: MapKind::CUBE,
        given: MapKind::FLAT,
    };
    assert_eq!(for_cubes.bind_group(&device, &flat).unwrap_err(), expected);
    assert!(for_cubes.bind_group(&device, &cube).is_ok());
    let for_flats = sampler(MapKind::FLAT);
    let expected = PcfError::Map {
        made_for: MapKind::FLAT,
        given: MapKind::CUBE,
    };
    assert_eq!(for_flats.bind_group(&device, &cube).unwrap_err(), expected);
    assert!(for_flats.bind_group(&device, &flat).is_ok());
}
