//! Targets of several samples, which shaders cannot read there.

use shadows::error::ScreenPassError;
use shadows::{ExactCount, ExactCountDescriptor, LightJoin, LightJoinDescriptor, wgpu};

use crate::common::noop_with;
use crate::gl;

#[test]
fn what_would_read_several_samples_is_refused() {
    let Some(gpu) = gl() else { return };
    let join = |device: &wgpu::Device, sample_count| {
        let descriptor = LightJoinDescriptor {
            depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
            sample_count,
            ..Default::default()
        };
        LightJoin::new(device, &descriptor).map(drop)
    };
    let count = |device: &wgpu::Device, sample_count| {
        let descriptor = ExactCountDescriptor {
            depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
            sample_count,
            ..Default::default()
        };
        ExactCount::new(device, &descriptor).map(drop)
    };
    let refused = |what| Err(ScreenPassError::SamplesOnGl { samples: 4, what });
    assert_eq!(join(&gpu.device, 4), refused("LightJoin"));
    assert_eq!(gpu.checked(|| join(&gpu.device, 1)), Ok(()));
    if gpu.support.float32_blending {
        assert_eq!(count(&gpu.device, 4), refused("ExactCount"));
        assert_eq!(gpu.checked(|| count(&gpu.device, 1)), Ok(()));
    }
    // Elsewhere they are made.
    let (device, _queue) = noop_with(wgpu::Features::FLOAT32_BLENDABLE, wgpu::Limits::defaults());
    assert_eq!(join(&device, 4), Ok(()));
    assert_eq!(count(&device, 4), Ok(()));
}
