//! What is decided for views that are drawn together, and what of them is refused. No driver needed.

use std::num::NonZeroU32;

use shadows::error::{
    MultiviewError, ScreenPassError, ShadowVolumeError as Error, VolumeDebugError,
    VolumeRenderError,
};
use shadows::glam::camera::rh::{proj::directx as proj, view as camera};
use shadows::glam::{Affine3A, Mat4, Vec3};
use shadows::{
    Caster, CasterState, Counter, DepthConvention, ExactCount, ExactCountDescriptor,
    HomogeneousLight, LightJoin, LightJoinDescriptor, ShadowMask, ShadowMaskDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, View, VolumeDebug,
    VolumeLight, VolumeView, wgpu,
};

use crate::errors::{FLOAT, LIGHT, bare, cubes, noop, view};
use host::random::Random;

const DEPTH: DepthConvention = DepthConvention::InfiniteReverse;

fn device(features: wgpu::Features, views: u32) -> (wgpu::Device, wgpu::Queue) {
    let limits = wgpu::Limits {
        max_multiview_view_count: views,
        ..wgpu::Limits::defaults()
    };
    noop(FLOAT | features, limits)
}

fn able() -> (wgpu::Device, wgpu::Queue) {
    device(wgpu::Features::MULTIVIEW, 4)
}

fn of_mask(mask: u32) -> ShadowVolumeDescriptor<'static> {
    ShadowVolumeDescriptor {
        multiview_mask: NonZeroU32::new(mask),
        ..Default::default()
    }
}

fn made(device: &wgpu::Device, mask: u32) -> Result<ShadowVolumeRenderer, Error> {
    ShadowVolumeRenderer::new(device, &of_mask(mask))
}

#[test]
fn a_device_is_asked_for_views_and_for_gaps_between_them() {
    let missing = |feature, mask: u32| Error::MissingFeature {
        feature,
        needed_by: format!("multiview_mask {mask:#b}"),
    };
    let error = made(&bare().0, 0b11).unwrap_err();
    assert_eq!(error, missing(wgpu::Features::MULTIVIEW, 0b11));
    assert!(error.to_string().contains("MULTIVIEW"), "{error}");
    let (device, _) = able();
    for mask in [0b1, 0b11, 0b1111] {
        assert!(made(&device, mask).is_ok(), "{mask:#b}");
    }
    let selective = wgpu::Features::SELECTIVE_MULTIVIEW;
    for mask in [0b10, 0b101] {
        let error = made(&device, mask).unwrap_err();
        assert_eq!(error, missing(selective, mask));
    }
    let limit = |needed| Error::Limit {
        name: "max_multiview_view_count",
        needed,
        available: 4,
    };
    assert_eq!(made(&device, 0b1_1111).unwrap_err(), limit(5));
    let (device, _) = self::device(wgpu::Features::MULTIVIEW | selective, 4);
    assert!(made(&device, 0b1010).is_ok());
    assert_eq!(made(&device, 1 << 31).unwrap_err(), limit(32));
}

fn told(view: View) -> VolumeView {
    VolumeView {
        view,
        target_size: Some([64; 2]),
    }
}

#[test]
fn views_that_cannot_be_drawn_together_are_refused_and_the_last_frame_is_kept() {
    let (device, queue) = able();
    let mut renderer = made(&device, 0b11).unwrap();
    let casters = cubes(&device, 3);
    let lights = [VolumeLight::from(LIGHT)];
    let mut prepare = |views: &[VolumeView]| {
        let frame = ShadowVolumeFrame {
            lights: &lights,
            views,
            casters: &casters,
            ..Default::default()
        };
        let result = renderer.prepare(&device, &queue, &frame);
        (result, renderer.caster_states(0, 0).len())
    };
    let one = told(view(DEPTH));
    assert_eq!(prepare(&[one; 4]), (Ok(()), 3));
    let refused = |error: MultiviewError| (Err(Error::from(error)), 3);
    let (views, together) = (3, 2);
    let error = MultiviewError::Views { views, together };
    assert_eq!(prepare(&[one; 3]), refused(error));
    let other = VolumeView {
        target_size: None,
        ..one
    };
    let error = MultiviewError::TargetSize {
        view: 3,
        found: None,
        needed: one.target_size,
    };
    assert_eq!(prepare(&[one, one, one, other]), refused(error));
    // Each pass has its own size.
    assert_eq!(prepare(&[one, one, other, other]), (Ok(()), 3));
    let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let mirrored = View::new(mirror * view(DEPTH).clip_from_world(), DEPTH).unwrap();
    let error = MultiviewError::Mirrored { view: 1 };
    assert_eq!(prepare(&[one, told(mirrored)]), refused(error));
    assert_eq!(prepare(&[told(mirrored); 2]), (Ok(()), 3));
    assert_eq!(prepare(&[]), (Ok(()), 0));
}

#[test]
fn a_pass_that_was_not_prepared_and_tools_of_one_view_are_refused() {
    let (device, queue) = able();
    let mut renderer = made(&device, 0b11).unwrap();
    let casters = cubes(&device, 2);
    let frame = ShadowVolumeFrame {
        lights: &[LIGHT.into()],
        views: &[told(view(DEPTH)); 2],
        casters: &casters,
        ..Default::default()
    };
    renderer.prepare(&device, &queue, &frame).unwrap();
    let [mut encoder, mut other] =
        [(); 2].map(|()| device.create_command_encoder(&Default::default()));
    renderer.encode(&mut encoder);
    let target = target(&device, 2);
    let mut pass = other.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(crate::passes::attach(&target, Some(0.0))),
        multiview_mask: NonZeroU32::new(0b11),
        ..Default::default()
    });
    assert_eq!(renderer.render(&mut pass, 0, 0), Ok(()));
    let no_such = VolumeRenderError::NoSuch {
        light: 0,
        view: 1,
        lights: 1,
        views: 1,
    };
    assert_eq!(renderer.render(&mut pass, 0, 1), Err(no_such));
    let one_view = VolumeRenderError::Multiview(2);
    assert_eq!(renderer.survey(0, 0, [64; 2]), Err(one_view));
    let mut debug = VolumeDebug::new(&device, &Default::default()).unwrap();
    assert_eq!(
        debug.draw_surfaces(&mut pass, &renderer, 0, 0),
        Err(one_view)
    );
    assert_eq!(debug.draw_edges(&mut pass, &renderer, 0, 0), Err(one_view));
    let refused = debug.prepare(&device, &frame, &renderer, 0, 0);
    assert_eq!(refused, Err(VolumeDebugError::Render(one_view)));
}

#[test]
fn light_passes_of_several_views_are_refused_where_they_do_not_fit() {
    let blends = wgpu::Features::FLOAT32_BLENDABLE;
    let (device, _queue) = device(blends | wgpu::Features::MULTIVIEW, 4);
    let (bare, _queue_of_bare) = noop(FLOAT | blends, wgpu::Limits::defaults());
    let exact = |mask: u32| ExactCountDescriptor {
        size: [64; 2],
        multiview_mask: NonZeroU32::new(mask),
        ..Default::default()
    };
    let masked = |mask: u32| ShadowMaskDescriptor {
        size: [64; 2],
        multiview_mask: NonZeroU32::new(mask),
        ..Default::default()
    };
    let joined = |mask: u32| LightJoinDescriptor {
        multiview_mask: NonZeroU32::new(mask),
        ..Default::default()
    };
    let errors = |device: &wgpu::Device, mask: u32, samples: u32| {
        let sample_count = samples;
        let (exact, masked, joined) = (exact(mask), masked(mask), joined(mask));
        let exact = ExactCountDescriptor {
            sample_count,
            ..exact
        };
        let masked = ShadowMaskDescriptor {
            sample_count,
            ..masked
        };
        let joined = LightJoinDescriptor {
            sample_count,
            ..joined
        };
        [
            ("ExactCount", ExactCount::new(device, &exact).err()),
            ("ShadowMask", ShadowMask::new(device, &masked).err()),
            ("LightJoin", LightJoin::new(device, &joined).err()),
        ]
    };
    for (needed_by, error) in errors(&bare, 0b11, 1) {
        let feature = wgpu::Features::MULTIVIEW;
        assert_eq!(
            error,
            Some(ScreenPassError::MissingFeature { feature, needed_by })
        );
    }
    for (_, error) in errors(&device, 0b1_1111, 1) {
        let (what, value, limit) = ("multiview_mask's number of layers", 5, 4);
        assert_eq!(error, Some(ScreenPassError::Range { what, value, limit }));
    }
    for (what, error) in errors(&device, 0b11, 4) {
        assert_eq!(
            error,
            Some(ScreenPassError::LayeredSamples { samples: 4, what })
        );
    }
    assert!(
        errors(&device, 0b11, 1)
            .iter()
            .all(|(_, error)| error.is_none())
    );
    // A light has a layer for each view.
    let most = device.limits().max_texture_array_layers;
    let lights = most / 2 + 1;
    let too_many = ShadowMaskDescriptor {
        lights,
        ..masked(0b11)
    };
    let (what, value, limit) = ("number of lights", lights, most / 2);
    let error = ScreenPassError::Range { what, value, limit };
    assert_eq!(ShadowMask::new(&device, &too_many).err(), Some(error));

    let mut encoder = device.create_command_encoder(&Default::default());
    let two = ExactCount::new(&device, &exact(0b11)).unwrap();
    let [found, needed] = [0b11, 0].map(NonZeroU32::new);
    let of_one = ShadowMaskDescriptor {
        counter: Counter::Exact,
        ..masked(0)
    };
    let of_one = ShadowMask::new(&device, &of_one).unwrap();
    let error = ScreenPassError::Multiview { found, needed };
    assert_eq!(of_one.encode_counts(&mut encoder, 0, &two), Err(error));
    let (found, needed) = (1, 2);
    let error = ScreenPassError::Layers { found, needed };
    let flat = target(&device, 1);
    assert_eq!(two.encode(&mut encoder, &flat), Err(error.clone()));
    assert_eq!(two.begin(&mut encoder, &flat).err(), Some(error.clone()));
    let mask = ShadowMask::new(&device, &masked(0b11)).unwrap();
    assert_eq!(mask.encode(&mut encoder, 0, &flat), Err(error.clone()));
    let join = LightJoin::new(&device, &joined(0b11)).unwrap();
    assert_eq!(join.bind(&flat).err(), Some(error));
    drop(encoder.finish());
}

/// A depth-stencil buffer of so many layers.
fn target(device: &wgpu::Device, layers: u32) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: 64,
            height: 64,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: ShadowVolumeDescriptor::default().depth_stencil_format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

/// A camera anywhere that looks anywhere.
fn random_view(random: &mut Random) -> VolumeView {
    let (eye, target) = (random.point(4.0), random.point(4.0));
    let projection = proj::perspective_infinite_reverse(0.7, 1.0, 0.1);
    let camera = camera::look_at_mat4(eye, target, Vec3::Y);
    View::new(projection * camera, DEPTH).unwrap().into()
}

/// What becomes of each caster in each pass.
fn states(
    (device, queue): &(wgpu::Device, wgpu::Queue),
    mask: u32,
    (light, views): (HomogeneousLight, &[VolumeView]),
    casters: &[Caster],
) -> Vec<Vec<CasterState>> {
    let mut renderer = made(device, mask).unwrap();
    let frame = ShadowVolumeFrame {
        lights: &[light.into()],
        views,
        casters,
        ..Default::default()
    };
    renderer.prepare(device, queue, &frame).unwrap();
    let passes = views.len() / mask.count_ones().max(1) as usize;
    let of = |pass| renderer.caster_states(0, pass);
    (0..passes).map(of).collect()
}

#[test]
fn what_is_decided_for_views_that_are_drawn_together_is_right_in_each() {
    use CasterState::{OutOfView, ZFail, ZPass};
    let gpu = able();
    let mut random = Random(7);
    let mut seen = std::collections::HashSet::new();
    for turn in 0..60 {
        let mesh = cubes(&gpu.0, 1)[0].mesh.clone();
        let place = |place| {
            let scale = Affine3A::from_scale(Vec3::splat(0.3));
            Caster::new(mesh.clone(), Affine3A::from_translation(place) * scale)
        };
        let casters: Vec<_> = (0..20).map(|_| place(random.point(4.0))).collect();
        let light = match turn % 2 {
            0 => HomogeneousLight::point(random.point(5.0)),
            _ => HomogeneousLight::directional(random.point(1.0)),
        };
        let views = [(); 3].map(|()| random_view(&mut random));
        let each = states(&gpu, 0, (light, &views), &casters);
        let joint = states(&gpu, 0b111, (light, &views), &casters);
        for (caster, joint) in joint[0].iter().enumerate() {
            let own: Vec<CasterState> = each.iter().map(|states| states[caster]).collect();
            let any = |state| own.contains(&state);
            let is_right = match joint {
                ZPass => any(ZPass) && !any(ZFail),
                // Out of a view by a plane that is none of those between which shadows fall on it.
                ZFail => any(ZFail) || any(OutOfView),
                OutOfView => !any(ZPass) && !any(ZFail),
                _ => false,
            };
            assert!(is_right, "{turn}: {own:?}, together {joint:?}");
            seen.insert((own[0], *joint));
        }
    }
    // As if the first view decided for all: it comes out otherwise in every way in which it can.
    for different in [(ZPass, ZFail), (OutOfView, ZFail), (OutOfView, ZPass)] {
        assert!(seen.contains(&different), "{different:?} of {seen:?}");
    }
    for same in [ZPass, ZFail, OutOfView] {
        assert!(seen.contains(&(same, same)), "{same:?}");
    }
}
