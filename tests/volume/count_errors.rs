//! Exact counts that a device or a pass cannot have are refused. No driver needed.

use shadows::error::{ScreenPassError, ShadowVolumeError};
use shadows::{
    Counter, ExactCount, ExactCountDescriptor, ShadowVolumeDescriptor, ShadowVolumeRenderer, wgpu,
};

use crate::errors::FLOAT;
use crate::passes::view_of;

#[test]
fn exact_counts_that_do_not_fit_are_refused() {
    let feature = wgpu::Features::FLOAT32_BLENDABLE;
    let device = |required_features| {
        wgpu::Device::noop(&wgpu::DeviceDescriptor {
            required_features: required_features | FLOAT,
            ..Default::default()
        })
    };
    let ok = ExactCountDescriptor {
        size: [64, 32],
        ..Default::default()
    };
    let (bare, _queue) = device(wgpu::Features::empty());
    assert_eq!(
        ExactCount::new(&bare, &ok).unwrap_err(),
        ScreenPassError::MissingFeature {
            feature,
            needed_by: "ExactCount"
        }
    );
    let descriptor = ShadowVolumeDescriptor {
        counter: Counter::Exact,
        ..Default::default()
    };
    let error = ShadowVolumeRenderer::new(&bare, &descriptor).unwrap_err();
    assert_eq!(
        error,
        ShadowVolumeError::MissingFeature {
            feature,
            needed_by: "Counter::Exact".to_owned()
        }
    );

    let (device, _queue) = device(feature);
    let eight = [Some(wgpu::TextureFormat::R8Unorm); 8];
    let crowded = ShadowVolumeDescriptor {
        color_formats: &eight,
        ..descriptor
    };
    assert!(matches!(
        ShadowVolumeRenderer::new(&device, &crowded),
        Err(ShadowVolumeError::Limit {
            name: "max_color_attachments",
            needed: 9,
            ..
        })
    ));
    ShadowVolumeRenderer::new(&device, &descriptor).unwrap();
    let none = ExactCountDescriptor { size: [0, 1], ..ok };
    assert!(matches!(
        ExactCount::new(&device, &none),
        Err(ScreenPassError::Range { what: "width", .. })
    ));
    let two = ExactCountDescriptor {
        sample_count: 2,
        ..ok
    };
    assert_eq!(
        ExactCount::new(&device, &two).unwrap_err(),
        ScreenPassError::SampleCount(2)
    );
    let counts = ExactCount::new(&device, &ok).unwrap();
    let buffer = |width| {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width,
                height: 32,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: ok.depth_stencil_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        view_of(&texture)
    };
    let mut encoder = device.create_command_encoder(&Default::default());
    let refused = |result| assert!(matches!(result, Err(ScreenPassError::Buffer { .. })));
    refused(counts.begin(&mut encoder, &buffer(65)).map(drop));
    refused(counts.encode(&mut encoder, &buffer(65)));
    counts.begin(&mut encoder, &buffer(64)).map(drop).unwrap();
    counts.encode(&mut encoder, &buffer(64)).unwrap();
}
