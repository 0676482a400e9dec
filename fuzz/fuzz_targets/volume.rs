//! Frames of shadow volumes: any light, range, casters and view, in every way and method.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use shadows::glam::Vec3;
use shadows::{
    Caps, Counter, ExactCount, ExactCountDescriptor, Extrusion, HomogeneousLight, Method,
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, Silhouettes, StartFrom,
    VolumeLight, VolumeView, wgpu,
};
use shadows_fuzz::Length;
use shadows_fuzz::gpu::{device, submit, tidy};
use shadows_fuzz::scene::{Camera, Cast, Corners, Light, Projection, Story};

const SIZE: [u8; 2] = [64, 48];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth24PlusStencil8;

#[derive(Arbitrary, Debug)]
struct Settings {
    projection: Projection,
    cap_bias_ulps: u32,
    method: u8,
    full_caps: bool,
    infinite: bool,
    culling: bool,
    keep_between_frames: bool,
    silhouettes: u8,
    away_facing: bool,
    exact: bool,
}

#[derive(Arbitrary, Debug)]
struct Frame {
    /// `None`: that of the frame before.
    light: Option<Light>,
    range: Option<Length>,
    target_size: Option<[u8; 2]>,
    receivers: Option<Corners>,
    casters: Cast,
    camera: Camera,
    /// Another than the renderer's.
    projection: Option<Projection>,
    encoded: bool,
    /// Whether the renderer is asked about its frame.
    asked: bool,
}

impl Settings {
    fn renderer(&self) -> ShadowVolumeRenderer {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: FORMAT,
            depth: self.projection.convention(),
            cap_bias_ulps: self.cap_bias_ulps % 1_000_000,
            method: [Method::Auto, Method::ZPass, Method::ZFail][usize::from(self.method % 3)],
            caps: match self.full_caps {
                true => Caps::Full,
                false => Caps::AsNeeded,
            },
            extrusion: match self.infinite {
                true => Extrusion::Infinite,
                false => Extrusion::ToRange,
            },
            culling: self.culling,
            keep_between_frames: self.keep_between_frames,
            silhouettes: [Silhouettes::Compute, Silhouettes::Cpu, Silhouettes::Vertex]
                [usize::from(self.silhouettes % 3)],
            start_from: match self.away_facing {
                true => StartFrom::AwayFacing,
                false => StartFrom::LightFacing,
            },
            counter: match self.exact {
                true => Counter::Exact,
                false => Counter::Stencil,
            },
            ..Default::default()
        };
        ShadowVolumeRenderer::new(&device().0, &descriptor).expect("a sound descriptor")
    }
}

fuzz_target!(|input: (Settings, Story<Frame>)| {
    let (settings, story) = input;
    let (device, queue) = device();
    let mut renderer = settings.renderer();
    // Of the last frame that was accepted.
    let mut target = [0; 2];
    let mut light = HomogeneousLight::directional(Vec3::Y);
    let scenes = story.upload();
    for frame in &story.frames {
        let projection = frame.projection.unwrap_or(settings.projection);
        let Some(view) = frame.camera.view(projection) else {
            continue;
        };
        let casters = &frame.casters.of(&scenes)[..];
        let before = renderer.statistics();
        if let Some(new) = frame.light {
            light = new.homogeneous();
        }
        let result = renderer.prepare(
            device,
            queue,
            &ShadowVolumeFrame {
                lights: &[VolumeLight::new(light, frame.range.map(|range| range.0))],
                views: &[VolumeView {
                    view,
                    target_size: frame.target_size.map(|size| size.map(u32::from)),
                }],
                receivers: frame.receivers.map(|corners| corners.0),
                casters,
            },
        );
        let s = renderer.statistics();
        match result {
            Ok(()) => {
                assert!(frame.receivers.is_none_or(|corners| corners.are_box()));
                assert!(settings.away_facing || s.casters_away_facing == 0, "{s:?}");
                assert!(s.casters_away_facing <= s.casters_drawn, "{s:?}");
                target = frame.target_size.unwrap_or(SIZE).map(u32::from);
                let counted = (s.casters_drawn + s.casters_skipped) as usize;
                assert_eq!(counted, casters.len(), "{s:?}");
                assert_eq!(
                    s.casters_z_pass + s.casters_z_fail,
                    s.casters_drawn,
                    "{s:?}"
                );
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                assert_eq!(s, before, "{error}: as it was");
            }
        }
        if frame.encoded && !target.contains(&0) {
            draw(&mut renderer, target, settings.exact);
        }
        if frame.asked {
            let _ = renderer.may_wrap(0, 0);
            if let Ok(survey) = renderer.survey(0, 0, target) {
                let fill = survey.fill();
                assert!(fill.is_finite() && fill >= 0.0, "{fill}");
            }
        }
    }
    tidy();
});

/// Records what a host would, for a target of the frame's size.
fn draw(renderer: &mut ShadowVolumeRenderer, [width, height]: [u32; 2], exact: bool) {
    let target = device().0.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = target.create_view(&Default::default());
    submit(|encoder| {
        renderer.encode(encoder);
        if exact {
            let descriptor = ExactCountDescriptor {
                size: [width, height],
                ..Default::default()
            };
            let count = ExactCount::new(&device().0, &descriptor).expect("it fits");
            renderer
                .render(&mut count.begin(encoder, &view).expect("it fits"), 0, 0)
                .expect("it is encoded");
            return count.encode(encoder, &view).expect("it fits");
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0),
                    store: wgpu::StoreOp::Store,
                }),
            }),
            ..Default::default()
        });
        renderer.render(&mut pass, 0, 0).expect("it is encoded");
    });
}
