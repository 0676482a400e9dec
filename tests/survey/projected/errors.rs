//! Bad input, each named before anything is changed.

use crate::common::shapes::cuboid;
use crate::common::{noop, noop_with, two_noop_devices};
use shadows::error::{CasterError, LightError, ProjectedShadowError as Error};
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    CasterMesh, DirectionalLight, PointLight, ProjectedCaster, ProjectedFrame, ProjectedShadow,
    ProjectedShadowDescriptor, Projector, wgpu,
};

fn made(device: &wgpu::Device, descriptor: &ProjectedShadowDescriptor<'_>) -> Option<Error> {
    ProjectedShadow::new(device, descriptor).err()
}

#[test]
fn layers_must_fit_the_device_and_the_memory() {
    let (device, _) = noop();
    for size in [0, 4, 100, 16384] {
        let descriptor = ProjectedShadowDescriptor {
            layer_size: size,
            ..Default::default()
        };
        let expected = Error::LayerSize {
            size,
            least: 8,
            limit: 8192,
        };
        assert_eq!(made(&device, &descriptor), Some(expected));
    }
    let descriptor = ProjectedShadowDescriptor {
        layer_size: 8,
        memory: 4 * 85 - 1,
        ..Default::default()
    };
    let (memory, layer) = (339, 340);
    assert_eq!(
        made(&device, &descriptor),
        Some(Error::Memory { memory, layer })
    );
    let enough = ProjectedShadowDescriptor {
        memory: layer,
        ..descriptor
    };
    assert_eq!(made(&device, &enough), None);
}

#[test]
fn each_bad_part_of_a_frame_is_named_and_the_shadows_stay_as_they_were() {
    let [(device, queue), (other, _)] = two_noop_devices();
    let mut shadow = ProjectedShadow::new(
        &device,
        &ProjectedShadowDescriptor {
            layer_size: 64,
            memory: 4 * 5461 * 2,
            ..Default::default()
        },
    )
    .unwrap();
    let at = Affine3A::from_translation(Vec3::Y);
    let good = [ProjectedCaster::opaque(
        cuboid(Vec3::ONE).caster(&device, at),
    )];
    let sun = DirectionalLight::new(Vec3::Y);
    let fine = Projector::new(sun, &good).with_size(64);
    let mut prepare = |projectors: &[Projector<'_>]| {
        let result = shadow.prepare(&device, &queue, &ProjectedFrame { projectors });
        let mut encoder = device.create_command_encoder(&Default::default());
        shadow.encode(&mut encoder);
        queue.submit([encoder.finish()]);
        result.err()
    };
    assert_eq!(prepare(&[fine]), None);
    for size in [0, 4, 48, 128] {
        let expected = Error::Size {
            projector: 1,
            size,
            least: 8,
            most: 64,
        };
        assert_eq!(prepare(&[fine, fine.with_size(size)]), Some(expected));
    }
    let dark = Projector::new(PointLight::new(Vec3::ZERO, -1.0), &good).with_size(8);
    let expected = Error::Light {
        projector: 0,
        source: LightError::Range(-1.0),
    };
    assert_eq!(prepare(&[dark]), Some(expected));
    let mut bad = [good[0].clone(), good[0].clone()];
    bad[1].caster.world_from_object.translation.x = f32::NAN;
    let of = |source| {
        Some(Error::Caster {
            projector: 1,
            source,
        })
    };
    let expected = of(CasterError::NotFinite { index: 1 });
    assert_eq!(
        prepare(&[fine, Projector::new(sun, &bad).with_size(8)]),
        expected
    );
    let elsewhere = [ProjectedCaster::opaque(
        cuboid(Vec3::ONE).caster(&other, at),
    )];
    let expected = of(CasterError::Device { index: 0 });
    assert_eq!(
        prepare(&[fine, Projector::new(sun, &elsewhere).with_size(8)]),
        expected
    );
    let mesh = CasterMesh::host_drawn(&device, good[0].caster.mesh.bounds(), 12).unwrap();
    let host = [ProjectedCaster::opaque(shadows::Caster::new(mesh, at))];
    let expected = Some(Error::HostDrawn {
        projector: 1,
        caster: 0,
    });
    assert_eq!(
        prepare(&[fine, Projector::new(sun, &host).with_size(8)]),
        expected
    );
    for part in [-0.1, 1.1, f32::NAN, f32::INFINITY] {
        let tinted = [ProjectedCaster::new(
            good[0].caster.clone(),
            [0.0, part, 1.0],
        )];
        let error = prepare(&[Projector::new(sun, &tinted).with_size(8)]).unwrap();
        let message = error.to_string();
        assert!(
            matches!(
                error,
                Error::Transmittance {
                    projector: 0,
                    caster: 0,
                    ..
                }
            ),
            "{message}"
        );
    }
    // Three tiles of a layer each, of two layers.
    let expected = Error::Space {
        shadows: 3,
        needed: 3 * 64 * 64,
        bound: 2 * 64 * 64,
    };
    assert_eq!(prepare(&[fine, fine, fine]), Some(expected));
    // What was drawn first is still there.
    assert_eq!(prepare(&[fine]), None);
    assert_eq!(shadow.statistics().shadows_kept, 1);
}

#[test]
fn more_than_buffers_hold_is_refused() {
    let limits = wgpu::Limits {
        max_buffer_size: 1000,
        ..wgpu::Limits::defaults()
    };
    let (device, queue) = noop_with(wgpu::Features::empty(), limits);
    let mut shadow = ProjectedShadow::new(&device, &Default::default()).unwrap();
    let sun = DirectionalLight::new(Vec3::Y);
    let caster = cuboid(Vec3::ONE).caster(&device, Affine3A::IDENTITY);
    let casters = vec![ProjectedCaster::opaque(caster); 16];
    let mut prepare = |projectors: &[Projector<'_>]| {
        shadow
            .prepare(&device, &queue, &ProjectedFrame { projectors })
            .err()
    };
    let expected = Error::TooManyCasters {
        casters: 16,
        size: 1024,
        limit: 1000,
    };
    assert_eq!(prepare(&[Projector::new(sun, &casters)]), Some(expected));
    let many = vec![Projector::new(sun, &[]); 11];
    let expected = Error::TooManyProjectors {
        projectors: 11,
        limit: 10,
    };
    assert_eq!(prepare(&many), Some(expected));
    assert_eq!(prepare(&many[..10]), None);
}
