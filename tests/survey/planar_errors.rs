//! What planar shadows refuse, and with which words. Without a driver.

use shadows::error::{LightError, PlanarShadowError as Error};
use shadows::glam::camera::rh::proj::directx;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    Caster, CasterMesh, DepthConvention, PlanarFrame, PlanarLight, PlanarOutline, PlanarOutput,
    PlanarReceiver, PlanarShadow, PlanarShadowDescriptor, PointLight, View, mesh::Adjacency, wgpu,
};

fn noop() -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_features: wgpu::Features::DEPTH32FLOAT_STENCIL8,
        ..Default::default()
    })
}

#[track_caller]
fn refused(descriptor: &PlanarShadowDescriptor<'_>, error: &Error) {
    let found = PlanarShadow::new(&noop().0, descriptor).unwrap_err();
    assert_eq!(found, *error);
    assert!(found.to_string().contains("pass"), "{found}");
}

#[test]
fn descriptors_that_do_not_fit_are_refused() {
    let usual = PlanarShadowDescriptor::default();
    assert!(PlanarShadow::new(&noop().0, &usual).is_ok());
    let depth_stencil_format = wgpu::TextureFormat::Depth32Float;
    let wrong = PlanarShadowDescriptor {
        depth_stencil_format,
        ..usual
    };
    let found = PlanarShadow::new(&noop().0, &wrong).unwrap_err();
    assert_eq!(found, Error::Format(depth_stencil_format));
    let (bare, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let found = PlanarShadow::new(&bare, &usual).unwrap_err();
    assert_eq!(found, Error::FormatFeature(usual.depth_stencil_format));
    let wrong = PlanarShadowDescriptor {
        sample_count: 2,
        ..usual
    };
    refused(&wrong, &Error::SampleCount(2));
    let format = wgpu::TextureFormat::Bc1RgbaUnorm;
    let wrong = PlanarShadowDescriptor {
        color_formats: &[None, Some(format)],
        ..usual
    };
    refused(&wrong, &Error::ColorFormat { place: 1, format });
    let eight = [Some(wgpu::TextureFormat::R8Unorm); 9];
    let lists: [(&[_], _, u64, u64); 3] = [
        (&eight, "max_color_attachments", 9, 8),
        // Those that have no format count, too.
        (&[None; 9], "max_color_attachments", 9, 8),
        (
            &[Some(wgpu::TextureFormat::Rgba32Float); 3],
            "max_color_attachment_bytes_per_sample",
            48,
            32,
        ),
    ];
    for (color_formats, name, needed, available) in lists {
        let wrong = PlanarShadowDescriptor {
            color_formats,
            ..usual
        };
        let error = Error::ColorLimit {
            name,
            needed,
            available,
        };
        refused(&wrong, &error);
        let fits = PlanarShadowDescriptor {
            color_formats: &color_formats[1..],
            ..usual
        };
        assert!(PlanarShadow::new(&noop().0, &fits).is_ok());
    }
    let unblended = Some(wgpu::TextureFormat::R32Uint);
    for (color_formats, target, found) in [
        (&[][..], 0, None),
        (&[None], 0, None),
        (&[unblended], 0, unblended),
        (&[unblended], 7, None),
    ] {
        let wrong = PlanarShadowDescriptor {
            color_formats,
            output: PlanarOutput::Darken { target },
            ..usual
        };
        refused(&wrong, &Error::Target { target, found });
    }
    for (shadow, outline, receivers) in [
        (0, 0x40, 0x3f),
        (0xc0, 0x20, 0x1f),
        (0x80, 0x80, 0x3f),
        (0x80, 0x40, 0x7f),
        (0x80, 3, 0),
    ] {
        let wrong = PlanarShadowDescriptor {
            shadow_bit: shadow,
            outline_bit: outline,
            receiver_bits: receivers,
            ..usual
        };
        let error = Error::Bits {
            shadow,
            outline,
            receivers,
        };
        refused(&wrong, &error);
    }
    for value in [-1.0, f32::INFINITY] {
        let wrong = PlanarShadowDescriptor {
            bias_pixels: value,
            ..usual
        };
        let field = "bias_pixels";
        refused(&wrong, &Error::Bias { field, value });
        let wrong = PlanarShadowDescriptor {
            bias_ulps: value,
            ..usual
        };
        let field = "bias_ulps";
        refused(&wrong, &Error::Bias { field, value });
    }
}

const CORNERS: [Vec3; 4] = [
    Vec3::new(-1.0, 0.0, -1.0),
    Vec3::new(-1.0, 0.0, 1.0),
    Vec3::new(1.0, 0.0, 1.0),
    Vec3::new(1.0, 0.0, -1.0),
];

fn view(depth: DepthConvention) -> View {
    let matrix = match depth {
        DepthConvention::Standard => directx::perspective(1.0, 1.0, 0.1, 10.0),
        _ => directx::perspective_infinite_reverse(1.0, 1.0, 0.1),
    };
    View::new(matrix, depth).unwrap()
}

#[test]
fn frames_that_are_not_sound_are_refused_and_change_nothing() {
    let (device, queue) = noop();
    let mut planar = PlanarShadow::new(&device, &PlanarShadowDescriptor::default()).unwrap();
    let positions = [[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
    let adjacency = Adjacency::new(&positions, &[0, 1, 2]).unwrap();
    let mesh = CasterMesh::new(&device, &positions, &adjacency).unwrap();
    let casters = [Caster::new(mesh, Affine3A::IDENTITY)];
    let lights = [PlanarLight::new(PointLight::new(Vec3::Y * 5.0, 30.0))];
    let planes = [PlanarReceiver {
        point: Vec3::ZERO,
        normal: Vec3::Y,
        outline: PlanarOutline::Polygon(&CORNERS),
    }];
    let views = [view(DepthConvention::InfiniteReverse)];
    let sound = PlanarFrame {
        lights: &lights,
        planes: &planes,
        views: &views,
        casters: &casters,
    };
    planar.prepare(&device, &queue, &sound).unwrap();
    let drawn = planar.statistics();
    assert_eq!(drawn.casters_drawn, 1);
    let mut refuse = |frame: &PlanarFrame<'_>, error: Error| {
        let found = planar.prepare(&device, &queue, frame).unwrap_err();
        assert_eq!(found, error);
        assert_eq!(planar.statistics(), drawn, "{found}");
    };

    let mut wrong = lights;
    wrong[0].light = PointLight::new(Vec3::Y, -1.0).into();
    let error = Error::Light {
        index: 0,
        error: LightError::Range(-1.0),
    };
    refuse(
        &PlanarFrame {
            lights: &wrong,
            ..sound
        },
        error,
    );
    let mut wrong = lights;
    wrong[0].shade = [0.0, 1.5, 0.0];
    let (index, shade) = (0, wrong[0].shade);
    refuse(
        &PlanarFrame {
            lights: &wrong,
            ..sound
        },
        Error::Shade { index, shade },
    );

    let plane = |change: &dyn Fn(&mut PlanarReceiver<'static>)| {
        let mut receiver = PlanarReceiver {
            point: Vec3::ZERO,
            normal: Vec3::Y,
            outline: PlanarOutline::Polygon(&CORNERS),
        };
        change(&mut receiver);
        [planes[0], receiver]
    };
    let wrong = plane(&|plane| plane.normal = Vec3::ZERO);
    let error = Error::Plane {
        index: 1,
        point: [0.0; 3],
        normal: [0.0; 3],
    };
    refuse(
        &PlanarFrame {
            planes: &wrong,
            ..sound
        },
        error,
    );
    for value in [0, 0x40, 0xff] {
        let wrong = plane(&|plane| plane.outline = PlanarOutline::Stencil(value));
        let error = Error::Value {
            index: 1,
            value,
            receivers: 0x3f,
        };
        refuse(
            &PlanarFrame {
                planes: &wrong,
                ..sound
            },
            error,
        );
    }
    let wrong = plane(&|plane| plane.outline = PlanarOutline::Polygon(&CORNERS[..2]));
    let error = Error::Outline {
        index: 1,
        corners: 2,
    };
    refuse(
        &PlanarFrame {
            planes: &wrong,
            ..sound
        },
        error,
    );
    let wrong = plane(&|plane| plane.point = Vec3::Y * 0.01);
    let error = Error::Corner {
        index: 1,
        corner: 0,
        position: CORNERS[0].to_array(),
    };
    refuse(
        &PlanarFrame {
            planes: &wrong,
            ..sound
        },
        error,
    );

    let wrong = [view(DepthConvention::Standard)];
    let error = Error::Depth {
        index: 0,
        made_for: DepthConvention::InfiniteReverse,
        view: DepthConvention::Standard,
    };
    refuse(
        &PlanarFrame {
            views: &wrong,
            ..sound
        },
        error,
    );
    let mut wrong = casters.clone();
    wrong[0].world_from_object.translation.x = f32::NAN;
    let frame = PlanarFrame {
        casters: &wrong,
        ..sound
    };
    let error = shadows::error::CasterError::NotFinite { index: 0 };
    refuse(&frame, error.into());
    let drawn_by_host = CasterMesh::host_drawn(&device, casters[0].mesh.bounds(), 1).unwrap();
    let drawn_by_host = Caster::new(drawn_by_host, Affine3A::IDENTITY);
    // Behind one that is as it was; and again, as it was before but not taken over; and behind one that moved.
    let wrong = [casters[0].clone(), drawn_by_host];
    let mut moved = wrong.clone();
    moved[0].world_from_object.translation.x += 1.0;
    for (wrong, index) in [(&wrong[..], 1), (&wrong, 1), (&wrong[1..], 0), (&moved, 1)] {
        let frame = PlanarFrame {
            casters: wrong,
            ..sound
        };
        refuse(&frame, Error::HostDrawn { index });
    }
}

#[test]
fn what_buffers_cannot_hold_is_refused() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_features: wgpu::Features::DEPTH32FLOAT_STENCIL8,
        required_limits: wgpu::Limits {
            max_buffer_size: 4096,
            max_uniform_buffer_binding_size: 4096,
            max_storage_buffer_binding_size: 4096,
            ..wgpu::Limits::defaults()
        },
        ..Default::default()
    });
    let mut planar = PlanarShadow::new(&device, &PlanarShadowDescriptor::default()).unwrap();
    let lights = [PlanarLight::new(PointLight::new(Vec3::Y * 5.0, 30.0)); 17];
    let planes = [PlanarReceiver {
        point: Vec3::ZERO,
        normal: Vec3::Y,
        outline: PlanarOutline::Stencil(1),
    }];
    let views = [view(DepthConvention::InfiniteReverse)];
    let frame = |lights| PlanarFrame {
        lights,
        planes: &planes,
        views: &views,
        casters: &[],
    };
    planar
        .prepare(&device, &queue, &frame(&lights[..16]))
        .unwrap();
    let error = Error::TooMany {
        what: "lights, planes and views",
        size: 17 * 256,
        limit: 4096,
    };
    let found = planar
        .prepare(&device, &queue, &frame(&lights))
        .unwrap_err();
    assert_eq!(found, error);
    let corners = vec![Vec3::ZERO; 200];
    let wide = [PlanarReceiver {
        outline: PlanarOutline::Polygon(&corners),
        ..planes[0]
    }];
    let frame = PlanarFrame {
        planes: &wide,
        ..frame(&lights[..1])
    };
    let found = planar.prepare(&device, &queue, &frame).unwrap_err();
    assert!(
        matches!(
            found,
            Error::TooMany {
                what: "corners",
                ..
            }
        ),
        "{found}"
    );
}
