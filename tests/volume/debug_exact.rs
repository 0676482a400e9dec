//! Debug views of hosts whose depth buffer has no stencil: exact counts in colours.

use host::one_light::OneLight;
use shadows::error::{ScreenPassError, VolumeDebugError};
use shadows::{
    Caster, DebugColors, ExactCount, ShadowVolumeRenderer, VolumeDebug, VolumeDebugDescriptor, wgpu,
};

use crate::counts::{exact, gpu, sheets, with};
use crate::debug_views::{Shown, nested};
use crate::passes::{HostPipelines, begin, clear, view_of};
use crate::pictures::{lamp, sun};
use crate::stage::Stage;
use host::gpu::Gpu;

/// What is drawn of a stage that was counted exactly.
struct Drawn<'a> {
    debug: &'a VolumeDebug,
    counts: &'a ExactCount,
    renderer: &'a ShadowVolumeRenderer,
}

/// A view over black of a stage that is counted exactly, with a depth buffer of this format.
fn shown(
    gpu: &Gpu,
    stage: &Stage,
    format: wgpu::TextureFormat,
    draw: impl Fn(&Drawn<'_>, &mut wgpu::RenderPass<'_>),
) -> Vec<[u8; 4]> {
    let stage = &Stage {
        format,
        ..with(stage, exact())
    };
    let color_format = wgpu::TextureFormat::Rgba8Unorm;
    let descriptor = VolumeDebugDescriptor {
        color_format,
        depth_stencil_format: format,
        sample_count: stage.samples,
        depth: stage.depth,
        ..Default::default()
    };
    let mut debug = VolumeDebug::new(&gpu.device, &descriptor).unwrap();
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    let casters: Vec<Caster> = stage.casters(gpu);
    stage.prepare(gpu, &mut renderer, &casters);
    OneLight::new(&stage.view(), stage.light, &casters)
        .with(|frame| debug.prepare(&gpu.device, frame, &renderer, 0, 0))
        .unwrap();
    let size = [stage.side; 2];
    let depth = view_of(&gpu.target(size, format, stage.samples));
    let picture = gpu.target(size, color_format, 1);
    let samples = view_of(&gpu.target(size, color_format, stage.samples));
    let resolved = view_of(&picture);
    let target = match stage.samples {
        1 => clear(&resolved, wgpu::Color::TRANSPARENT, None),
        _ => clear(&samples, wgpu::Color::TRANSPARENT, Some(&resolved)),
    };
    let read_only = wgpu::RenderPassDepthStencilAttachment {
        view: &depth,
        depth_ops: None,
        stencil_ops: None,
    };
    let (host, surfaces) = (HostPipelines::new(gpu, stage), stage.surfaces(gpu));
    let counts = stage.exact_count(gpu);
    gpu.checked(|| {
        gpu.run(|encoder| {
            renderer.encode(encoder);
            stage.prepass(encoder, &depth, &host, &surfaces);
            renderer
                .render(&mut counts.begin(encoder, &depth).unwrap(), 0, 0)
                .unwrap();
            let drawn = Drawn {
                debug: &debug,
                counts: &counts,
                renderer: &renderer,
            };
            let mut pass = begin(encoder, "debug", &[Some(target)], read_only);
            draw(&drawn, &mut pass);
        });
    });
    let bytes = gpu.read_texture(&picture, 0, wgpu::TextureAspect::All);
    bytes.as_chunks::<4>().0.to_vec()
}

fn counts(drawn: &Drawn<'_>, pass: &mut wgpu::RenderPass<'_>) {
    drawn.debug.draw_exact_counts(pass, drawn.counts).unwrap();
}

/// Formats of depth alone, and those of the same depth with a stencil.
const ALONE: [[wgpu::TextureFormat; 2]; 2] = [
    [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth32FloatStencil8,
    ],
    [
        wgpu::TextureFormat::Depth24Plus,
        wgpu::TextureFormat::Depth24PlusStencil8,
    ],
];

#[test]
fn exact_counts_have_the_colours_of_the_stencils() {
    let Some(gpu) = gpu() else { return };
    for samples in [1, 4] {
        for [alone, format] in ALONE {
            let stage = Stage {
                samples,
                format,
                ..nested(lamp())
            };
            let right =
                Shown::new(&gpu, &stage).view(|debug, pass| debug.draw_counts(pass).unwrap());
            assert!(right.iter().filter(|color| **color != [0; 4]).count() > 1_000);
            for format in [alone, format] {
                let found = shown(&gpu, &stage, format, counts);
                assert!(found == right, "{format:?}, {samples} samples");
            }
            // Those of another light are others.
            let other = Stage {
                light: sun(),
                ..stage.clone()
            };
            assert!(shown(&gpu, &other, alone, counts) != right);
        }
    }
}

#[test]
fn no_exact_count_is_taken_for_a_negative_one() {
    let Some(gpu) = gpu() else { return };
    let colors = DebugColors::default();
    let bytes = |color: [f32; 4]| color.map(|x| (x * 255.0).round() as u8);
    // The stencil would say 255, and 0.
    for count in [255, 256] {
        let picture = shown(&gpu, &sheets(count), ALONE[0][0], counts);
        let many = bytes(colors.counts[7]);
        let found = picture.iter().filter(|color| **color == many).count();
        assert!(found > 500, "{count}: {found}");
        assert!(!picture.contains(&bytes(colors.negative)));
    }
}

#[test]
fn the_other_views_need_no_stencil() {
    let Some(gpu) = gpu() else { return };
    type View = fn(&Drawn<'_>, &mut wgpu::RenderPass<'_>);
    let views: [View; 3] = [
        |drawn, pass| {
            let surfaces = drawn.debug.draw_surfaces(pass, drawn.renderer, 0, 0);
            surfaces.unwrap();
        },
        |drawn, pass| {
            drawn.debug.draw_edges(pass, drawn.renderer, 0, 0).unwrap();
        },
        |drawn, pass| drawn.debug.draw_casters(pass),
    ];
    for view in views {
        let [alone, both] = ALONE[0].map(|format| shown(&gpu, &nested(lamp()), format, view));
        assert!(alone == both);
        assert!(alone.iter().filter(|color| **color != [0; 4]).count() > 100);
    }
}

#[test]
fn what_there_is_not_is_not_shown() {
    let Some(gpu) = gpu() else { return };
    let stage = nested(lamp());
    let several = Stage {
        samples: 4,
        format: ALONE[0][0],
        ..stage.clone()
    };
    let others = several.exact_count(&gpu);
    let format = ALONE[0][0];
    let picture = shown(&gpu, &stage, format, |drawn, pass| {
        let no_stencil = VolumeDebugError::NoStencil(format);
        assert_eq!(drawn.debug.draw_counts(pass), Err(no_stencil));
        let other = ScreenPassError::Source {
            found: 4,
            needed: 1,
        };
        let refused = drawn.debug.draw_exact_counts(pass, &others);
        assert_eq!(refused, Err(other.into()));
    });
    assert!(picture.iter().all(|color| *color == [0; 4]));
}
