//! Hosts whose depth buffer has no stencil: counted exactly, read from a mask.

use shadows::error::{ScreenPassError, ShadowVolumeError};
use shadows::{
    Counter, ExactCount, ExactCountDescriptor, ShadowMask, ShadowMaskDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeRenderer, wgpu,
};

use crate::counts::{exact, gpu, sheets, with};
use crate::errors::noop;
use crate::passes::{HostPipelines, view_of};
use crate::pictures::{lamp, mixed, sun};
use crate::stage::Stage;
use host::gpu::Gpu;

const ALONE: [wgpu::TextureFormat; 2] = [
    wgpu::TextureFormat::Depth32Float,
    wgpu::TextureFormat::Depth24Plus,
];

/// The mask of a stage whose buffer has this format.
fn mask(gpu: &Gpu, stage: &Stage, format: wgpu::TextureFormat) -> Vec<u8> {
    let stage = &Stage {
        format,
        ..with(stage, exact())
    };
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    let depth = view_of(&gpu.target([stage.side; 2], format, stage.samples));
    let (host, surfaces) = (HostPipelines::new(gpu, stage), stage.surfaces(gpu));
    let counts = stage.exact_count(gpu);
    let descriptor = ShadowMaskDescriptor {
        size: [stage.side; 2],
        lights: 2,
        sample_count: stage.samples,
        counter: Counter::Exact,
        ..Default::default()
    };
    let mask = ShadowMask::new(&gpu.device, &descriptor).unwrap();
    gpu.checked(|| {
        gpu.run(|encoder| {
            renderer.encode(encoder);
            stage.prepass(encoder, &depth, &host, &surfaces);
            renderer
                .render(&mut counts.begin(encoder, &depth).unwrap(), 0, 0)
                .unwrap();
            mask.encode_counts(encoder, 1, &counts).unwrap();
            // Asked for what there is not.
            let no_stencil = ScreenPassError::NoStencil(format);
            assert_eq!(counts.encode(encoder, &depth), Err(no_stencil));
            let other = ScreenPassError::Counter(Counter::Exact);
            assert_eq!(mask.encode(encoder, 1, &depth), Err(other));
            let no_layer = ScreenPassError::Layer {
                light: 2,
                lights: 2,
            };
            assert_eq!(mask.encode_counts(encoder, 2, &counts), Err(no_layer));
        });
    });
    gpu.read_texture(mask.texture(), 1, wgpu::TextureAspect::All)
}

#[test]
fn a_depth_buffer_alone_gives_the_picture_that_a_stencil_gives() {
    let Some(gpu) = gpu() else { return };
    for stage in [mixed(lamp()), mixed(sun())] {
        let stage = Stage {
            format: wgpu::TextureFormat::Depth32FloatStencil8,
            ..stage
        };
        let right = stage.draw(&gpu);
        assert!(right.contains(&0) && right.contains(&255));
        assert!(mask(&gpu, &stage, wgpu::TextureFormat::Depth32Float) == right);
        let coarse = Stage {
            format: wgpu::TextureFormat::Depth24PlusStencil8,
            ..stage.clone()
        };
        let coarse = coarse.draw(&gpu);
        assert!(mask(&gpu, &stage, wgpu::TextureFormat::Depth24Plus) == coarse);
    }
    // Another light has another mask.
    let [one, other] = [lamp(), sun()].map(|light| mask(&gpu, &mixed(light), ALONE[0]));
    assert!(one != other);
    // A byte would leave no shadow of 256 volumes.
    let many = sheets(256);
    assert!(mask(&gpu, &many, ALONE[0]).contains(&0));
}

#[test]
fn a_mask_of_several_samples_is_the_share_that_is_lit() {
    let Some(gpu) = gpu() else { return };
    let stage = Stage {
        samples: 4,
        ..mixed(lamp())
    };
    let found = mask(&gpu, &stage, ALONE[0]);
    let right = stage.draw(&gpu);
    let mut between = 0;
    for (found, right) in found.iter().zip(&right) {
        // Quarters of 255, which resolving rounds in its own way.
        assert!(found.abs_diff(*right) <= 1, "{found}, {right}");
        between += usize::from(*found > 0 && *found < 255);
    }
    assert!(between > 50, "{between}");
}

#[test]
fn what_needs_a_stencil_says_so() {
    let (device, _queue) = noop(wgpu::Features::FLOAT32_BLENDABLE, wgpu::Limits::defaults());
    let new = |depth_stencil_format, counter| {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format,
            counter,
            ..Default::default()
        };
        ShadowVolumeRenderer::new(&device, &descriptor).map(|_| ())
    };
    for format in ALONE {
        assert_eq!(new(format, Counter::Exact), Ok(()));
        let refused = Err(ShadowVolumeError::Format(format));
        assert_eq!(new(format, Counter::Stencil), refused);
    }
    for format in [
        wgpu::TextureFormat::Stencil8,
        wgpu::TextureFormat::Depth16Unorm,
        wgpu::TextureFormat::R32Float,
    ] {
        let refused = Err(ShadowVolumeError::Format(format));
        assert_eq!(new(format, Counter::Exact), refused);
    }
    let counts = |size, sample_count| {
        let descriptor = ExactCountDescriptor {
            size,
            sample_count,
            depth_stencil_format: ALONE[0],
            ..Default::default()
        };
        ExactCount::new(&device, &descriptor)
    };
    let descriptor = ShadowMaskDescriptor {
        size: [8, 8],
        counter: Counter::Exact,
        ..Default::default()
    };
    let mask = ShadowMask::new(&device, &descriptor).unwrap();
    let mut encoder = device.create_command_encoder(&Default::default());
    for (size, samples) in [([8, 9], 1), ([8, 8], 4)] {
        let other = counts(size, samples).unwrap();
        let refused = mask.encode_counts(&mut encoder, 0, &other);
        assert!(
            matches!(refused, Err(ScreenPassError::Buffer { .. })),
            "{refused:?}"
        );
    }
    let own = counts([8, 8], 1).unwrap();
    assert_eq!(mask.encode_counts(&mut encoder, 0, &own), Ok(()));
    let by_stencil = ShadowMaskDescriptor {
        depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
        counter: Counter::Stencil,
        ..descriptor
    };
    let by_stencil = ShadowMask::new(&device, &by_stencil).unwrap();
    let refused = ScreenPassError::Counter(Counter::Stencil);
    assert_eq!(
        by_stencil.encode_counts(&mut encoder, 0, &own),
        Err(refused)
    );
    let bad = counts([8, 8], 3).err();
    assert_eq!(bad, Some(ScreenPassError::SampleCount(3)));
}
