//! Every error of the debug views is reached, and leaves them usable. No driver needed.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::error::{
    CasterError, ScreenPassError, ShadowVolumeError, VolumeDebugError as Error, VolumeRenderError,
};
use shadows::{
    CasterState, DepthConvention, ShadowVolumeDescriptor, ShadowVolumeRenderer, VolumeDebug,
    VolumeDebugDescriptor, wgpu,
};

use crate::errors::{FLOAT, LIGHT, bare, cubes, noop, two_devices, view};

fn new(device: &wgpu::Device, descriptor: VolumeDebugDescriptor<'_>) -> Result<(), Error> {
    VolumeDebug::new(device, &descriptor).map(|_| ())
}

#[test]
fn a_pass_that_does_not_fit_is_refused() {
    let (device, _) = bare();
    let ok = VolumeDebugDescriptor::default();
    assert_eq!(new(&device, ok), Ok(()));
    let depth_stencil_format = wgpu::TextureFormat::Depth16Unorm;
    let refused = ScreenPassError::Format(depth_stencil_format);
    let descriptor = VolumeDebugDescriptor {
        depth_stencil_format,
        ..ok
    };
    assert_eq!(new(&device, descriptor), Err(refused.into()));
    let color_format = wgpu::TextureFormat::R32Uint;
    let refused = ScreenPassError::ColorFormat(color_format);
    let descriptor = VolumeDebugDescriptor { color_format, ..ok };
    assert_eq!(new(&device, descriptor), Err(refused.into()));
    let descriptor = VolumeDebugDescriptor {
        sample_count: 3,
        ..ok
    };
    let refused = ScreenPassError::SampleCount(3);
    assert_eq!(new(&device, descriptor), Err(refused.into()));
}

#[test]
fn features_and_limits_are_asked_for() {
    let (device, _) = bare();
    let descriptor = VolumeDebugDescriptor {
        depth: DepthConvention::Standard,
        ..Default::default()
    };
    let missing = ShadowVolumeError::MissingFeature {
        feature: wgpu::Features::DEPTH_CLIP_CONTROL,
        needed_by: "DepthConvention::Standard".into(),
    };
    assert_eq!(new(&device, descriptor), Err(missing.into()));
    let limits = wgpu::Limits {
        max_dynamic_uniform_buffers_per_pipeline_layout: 1,
        ..wgpu::Limits::defaults()
    };
    let (device, _) = noop(FLOAT, limits);
    let low = ShadowVolumeError::Limit {
        name: "max_dynamic_uniform_buffers_per_pipeline_layout",
        needed: 4,
        available: 1,
    };
    assert_eq!(new(&device, Default::default()), Err(low.into()));
}

#[test]
fn a_frame_that_is_not_the_renderers_is_refused() {
    let [(device, queue), (stranger, _)] = two_devices();
    let mut debug = VolumeDebug::new(&device, &Default::default()).unwrap();
    let descriptor = ShadowVolumeDescriptor::default();
    let mut renderer = ShadowVolumeRenderer::new(&device, &descriptor).unwrap();
    assert_eq!(renderer.caster_states(0, 0), []);
    let view = view(DepthConvention::InfiniteReverse);
    let casters = cubes(&device, 3);
    let frame = OneLight::new(&view, LIGHT, &casters);
    let no_such = |[light, view]: [usize; 2], [lights, views]: [usize; 2]| {
        Error::Render(VolumeRenderError::NoSuch {
            light,
            view,
            lights,
            views,
        })
    };
    assert_eq!(
        frame.with(|frame| debug.prepare(&device, frame, &renderer, 0, 0)),
        Err(no_such([0, 0], [0, 0]))
    );
    renderer.prepare_one(&device, &queue, &frame).unwrap();
    for [light, view] in [[1, 0], [0, 1]] {
        assert_eq!(
            frame.with(|frame| debug.prepare(&device, frame, &renderer, light, view)),
            Err(no_such([light, view], [1, 1]))
        );
    }
    let fewer = OneLight {
        casters: &casters[..2],
        ..frame
    };
    let other = Error::Casters {
        frame: 2,
        renderer: 3,
    };
    assert_eq!(
        fewer.with(|frame| debug.prepare(&device, frame, &renderer, 0, 0)),
        Err(other)
    );
    assert_eq!(
        frame.with(|frame| debug.prepare(&device, frame, &renderer, 0, 0)),
        Ok(())
    );
    assert!(renderer.caster_states(0, 0).len() == 3);
    assert!(!renderer.caster_states(0, 0).contains(&CasterState::Empty));
    let strange = cubes(&stranger, 3);
    let frame = OneLight {
        casters: &strange,
        ..frame
    };
    let refused = ShadowVolumeError::from(CasterError::Device { index: 0 });
    assert_eq!(
        frame.with(|frame| debug.prepare(&device, frame, &renderer, 0, 0)),
        Err(refused.into())
    );
}

#[test]
fn another_depth_convention_is_refused() {
    let clip = wgpu::Features::DEPTH_CLIP_CONTROL;
    let (device, _) = noop(FLOAT | clip, wgpu::Limits::defaults());
    let mut debug = VolumeDebug::new(&device, &Default::default()).unwrap();
    let depth = DepthConvention::Standard;
    let descriptor = ShadowVolumeDescriptor {
        depth,
        ..Default::default()
    };
    let renderer = ShadowVolumeRenderer::new(&device, &descriptor).unwrap();
    let view = view(depth);
    let frame = OneLight::new(&view, LIGHT, &[]);
    let refused = Error::Depth {
        debug: DepthConvention::InfiniteReverse,
        renderer: depth,
    };
    assert_eq!(
        frame.with(|frame| debug.prepare(&device, frame, &renderer, 0, 0)),
        Err(refused)
    );
}
