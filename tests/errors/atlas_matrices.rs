//! More lights than a buffer holds the matrices of.

use glam::{Affine3A, Vec3};
use shadows::error::ShadowAtlasError;
use shadows::{
    AtlasFrame, AtlasLight, PointLight, ShadowAtlas, ShadowAtlasDescriptor, TileSize, glam, wgpu,
};

use crate::common::shapes::cuboid;
use crate::common::{noop_with, validation_error};

#[test]
fn lights_whose_matrices_no_buffer_holds_are_refused() {
    // 2 KiB of matrices a light, which is more than its record.
    let limits = wgpu::Limits {
        max_buffer_size: (64 << 10) + 2,
        ..wgpu::Limits::defaults()
    };
    let (device, queue) = noop_with(wgpu::Features::empty(), limits);
    let descriptor = ShadowAtlasDescriptor {
        layer_size: 256,
        ..Default::default()
    };
    let mut atlas = ShadowAtlas::new(&device, &descriptor).unwrap();
    let lamp = |_| {
        let lamp = AtlasLight::new(PointLight::new(Vec3::Y * 3.0, 9.0));
        lamp.with_size(TileSize::Fixed(16))
    };
    let mut lights: Vec<AtlasLight> = (0..32).map(lamp).collect();
    let caster = cuboid(Vec3::splat(0.2)).caster(&device, Affine3A::IDENTITY);
    let mut prepare = |lights: &[AtlasLight]| {
        let frame = AtlasFrame {
            lights,
            casters: std::slice::from_ref(&caster),
            ..Default::default()
        };
        let mut result = Ok(());
        let error = validation_error(&device, || {
            result = atlas.prepare(&device, &queue, &frame);
        });
        assert_eq!(error, None);
        result
    };
    // Room is made in powers of two, but no more than there can be.
    for count in [17, 31, 32] {
        assert_eq!(prepare(&lights[..count]), Ok(()));
    }
    lights.push(lamp(32));
    let error = ShadowAtlasError::TooManyMatrices {
        lights: 33,
        size: 33 * 2048,
        limit: 64 << 10,
    };
    assert_eq!(prepare(&lights), Err(error));
    assert_eq!(prepare(&lights[..32]), Ok(()));
}
