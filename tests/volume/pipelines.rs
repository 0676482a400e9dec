//! What is compiled is compiled once, whoever needs it. No driver needed.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use shadows::error::ShadowVolumeError;
use shadows::{
    Counter, DepthConvention, Method, ShadowVolumeDescriptor, ShadowVolumeRenderer, Silhouettes,
    StartFrom, VolumePipelines, rewriting, wgpu,
};

use crate::errors::{FLOAT, noop};

fn device() -> wgpu::Device {
    let features = FLOAT | wgpu::Features::DEPTH_CLIP_CONTROL | wgpu::Features::FLOAT32_BLENDABLE;
    noop(features, wgpu::Limits::defaults()).0
}

/// How many shader modules of this crate are compiled while something is done: what is counted
/// does not ask the set itself.
fn modules(work: impl FnOnce()) -> usize {
    let count = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&count);
    rewriting::set(Some(Box::new(move |wgsl| {
        counted.fetch_add(1, Ordering::Relaxed);
        wgsl.to_owned()
    })));
    work();
    rewriting::set(None);
    count.load(Ordering::Relaxed)
}

fn descriptors() -> Vec<ShadowVolumeDescriptor<'static>> {
    let ways = [
        Silhouettes::Compute,
        Silhouettes::Cpu,
        Silhouettes::Vertex,
        Silhouettes::Auto,
    ];
    ways.into_iter()
        .flat_map(|silhouettes| {
            let by_default = ShadowVolumeDescriptor {
                silhouettes,
                ..Default::default()
            };
            [
                by_default,
                ShadowVolumeDescriptor {
                    start_from: StartFrom::AwayFacing,
                    ..by_default
                },
                ShadowVolumeDescriptor {
                    depth: DepthConvention::Standard,
                    ..by_default
                },
                ShadowVolumeDescriptor {
                    counter: Counter::Exact,
                    sample_count: 4,
                    ..by_default
                },
            ]
        })
        .collect()
}

#[test]
fn a_second_renderer_compiles_nothing() {
    let device = device();
    for descriptor in descriptors() {
        let pipelines = VolumePipelines::new(&device, None);
        let make = |pipelines: &VolumePipelines, descriptor: &ShadowVolumeDescriptor<'_>| {
            ShadowVolumeRenderer::with_pipelines(pipelines, descriptor).unwrap();
        };
        assert!(modules(|| make(&pipelines, &descriptor)) > 0);
        let count = pipelines.count();
        assert!(count >= 13, "{count}");
        let other_choices = ShadowVolumeDescriptor {
            label: Some("second"),
            method: Method::ZFail,
            culling: false,
            keep_between_frames: false,
            ..descriptor
        };
        for descriptor in [descriptor, other_choices] {
            let clone = pipelines.clone();
            assert_eq!(modules(|| make(&clone, &descriptor)), 0);
            assert_eq!(pipelines.count(), count);
        }
        // Without a common set, each compiles its own.
        let alone = || {
            ShadowVolumeRenderer::new(&device, &descriptor).unwrap();
        };
        assert!(modules(alone) > 0);
        assert_eq!(pipelines.count(), count);
    }
}

#[test]
fn warming_up_leaves_nothing_to_compile_and_another_pass_needs_its_own() {
    let device = device();
    let pipelines = VolumePipelines::new(&device, None);
    assert_eq!(pipelines.count(), 0);
    for descriptor in descriptors() {
        pipelines.warm_up(&descriptor).unwrap();
        let warm = pipelines.count();
        let make = || {
            ShadowVolumeRenderer::with_pipelines(&pipelines, &descriptor).unwrap();
        };
        assert_eq!(modules(make), 0);
        assert_eq!(pipelines.count(), warm);
    }
    let before = pipelines.count();
    let other_format = ShadowVolumeDescriptor {
        depth_stencil_format: wgpu::TextureFormat::Depth24PlusStencil8,
        ..Default::default()
    };
    pipelines.warm_up(&other_format).unwrap();
    assert!(pipelines.count() > before);
    let both_starts = ShadowVolumeDescriptor {
        start_from: StartFrom::AwayFacing,
        ..other_format
    };
    let before = pipelines.count();
    pipelines.warm_up(&both_starts).unwrap();
    // What both have is there: only the parts of away-facing starts are new.
    assert_eq!(pipelines.count(), before + 14);
    let no_format = ShadowVolumeDescriptor {
        depth_stencil_format: wgpu::TextureFormat::Rgba8Unorm,
        ..Default::default()
    };
    let refused = ShadowVolumeError::Format(wgpu::TextureFormat::Rgba8Unorm);
    assert_eq!(pipelines.warm_up(&no_format), Err(refused));
    assert_eq!(pipelines.count(), before + 14);
}
