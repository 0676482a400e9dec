//! Inputs that fuzzing (`fuzz/`) broke something with, and their kin.

use crate::common::noop;
use crate::common::shapes::square;
use glam::{Affine3A, Vec3};
use shadows::error::{CasterMeshError, ShadowMapError};
use shadows::mesh::{Adjacency, Bounds};
use shadows::{
    Caster, CasterMesh, DirectionalLight, FlatLight, HostPositions, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, SpotLight, glam, wgpu,
};

const SPOT: SpotLight = SpotLight {
    position: Vec3::new(0.0, 4.0, 0.0),
    direction: Vec3::NEG_Y,
    half_angle: 0.28,
    range: 30.0,
    near: None,
};

#[test]
fn a_flat_map_that_f32_cannot_place_is_refused_and_the_map_goes_on() {
    let (device, queue) = noop();
    let mut map = ShadowMap::new(&device, &ShadowMapDescriptor::default()).unwrap();
    let near = [square(1.0).caster(&device, Affine3A::IDENTITY)];
    let sound = ShadowFrame::new(FlatLight::Spot(SPOT), &near);
    map.prepare(&device, &queue, &sound).unwrap();
    let (before, matrix) = (map.statistics(), map.clip_from_world());
    assert!(matrix.unwrap().is_finite());

    let far = SpotLight {
        position: Vec3::splat(2e38),
        ..SPOT
    };
    let narrow = SpotLight {
        half_angle: 1e-42,
        ..SPOT
    };
    let sun = FlatLight::Directional(DirectionalLight::new(Vec3::ONE));
    let huge = [square(1.0).caster(&device, Affine3A::from_scale(Vec3::splat(3e38)))];
    for (light, casters) in [
        (FlatLight::Spot(far), &near),
        (FlatLight::Spot(narrow), &near),
        (sun, &huge),
    ] {
        let refused = map.prepare(&device, &queue, &ShadowFrame::new(light, casters));
        assert_eq!(refused, Err(ShadowMapError::BeyondF32), "{light:?}");
        assert_eq!((map.statistics(), map.clip_from_world()), (before, matrix));
    }
    map.prepare(&device, &queue, &sound).unwrap();
    assert_eq!(map.clip_from_world(), matrix);

    // As far as that again, and it is accepted.
    let nearer = SpotLight {
        position: Vec3::splat(2e36),
        ..SPOT
    };
    let frame = ShadowFrame::new(FlatLight::Spot(nearer), &near);
    map.prepare(&device, &queue, &frame).unwrap();
    assert!(map.clip_from_world().unwrap().is_finite());
}

#[test]
fn a_directional_map_of_no_extent_is_finite() {
    let (device, queue) = noop();
    let mut map = ShadowMap::new(&device, &ShadowMapDescriptor::default()).unwrap();
    let sun = FlatLight::Directional(DirectionalLight::new(Vec3::new(0.3, 1.0, 0.2)));

    // All of whose triangles collapse to one point: nothing casts.
    let positions = [[1.0_f32, 2.0, 3.0]; 3];
    let adjacency = Adjacency::new(&positions, &[0, 1, 2]).unwrap();
    let point = CasterMesh::new(&device, &positions, &adjacency).unwrap();
    let nothing = [Caster::new(point, Affine3A::IDENTITY)];
    let frame = ShadowFrame::new(sun, &nothing);
    map.prepare(&device, &queue, &frame).unwrap();
    assert_eq!(map.clip_from_world(), None);

    // Receivers that are one point, and a caster scaled down to one.
    let casters = [square(1.0).caster(&device, Affine3A::IDENTITY)];
    let specks = [square(1.0).caster(&device, Affine3A::from_scale(Vec3::ZERO))];
    for at in [Vec3::ZERO, Vec3::new(0.5, 0.0, 0.5)] {
        let receivers = Some(Bounds { min: at, max: at });
        for casters in [&casters, &specks] {
            let frame = ShadowFrame {
                receivers,
                ..ShadowFrame::new(sun, casters)
            };
            map.prepare(&device, &queue, &frame).unwrap();
            let matrix = map.clip_from_world();
            assert!(matrix.is_none_or(|matrix| matrix.is_finite()), "{matrix:?}");
        }
    }
    let frame = ShadowFrame::new(sun, &specks);
    map.prepare(&device, &queue, &frame).unwrap();
    assert!(map.clip_from_world().unwrap().is_finite());
}

#[test]
fn bounds_of_host_positions_that_are_inside_out_are_refused() {
    let (device, _) = noop();
    let positions = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let adjacency = Adjacency::new(&positions, &[0, 1, 2]).unwrap();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 36,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let made = |min: Vec3, max: Vec3| {
        let host = HostPositions {
            buffer: &buffer,
            stride: 12,
            offset: 0,
            bounds: Bounds { min, max },
        };
        CasterMesh::from_host_positions(&device, &host, &adjacency).map(|mesh| mesh.bounds())
    };
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        let (min, max) = (axis, Vec3::ONE - axis);
        let refused = CasterMeshError::Bounds {
            min: min.to_array(),
            max: max.to_array(),
        };
        assert_eq!(made(min, max), Err(refused));
    }
    // A plane, or a point, is a box.
    assert!(made(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)).is_ok());
    assert!(made(Vec3::ONE, Vec3::ONE).is_ok());
}
