//! What light passes need, in passes of several views: masks, exact counts, pictures joined.

use shadows::{
    Counter, ExactCount, ExactCountDescriptor, LightJoin, LightJoinDescriptor, ShadowMask,
    ShadowMaskDescriptor, wgpu,
};

use crate::layers::{Pass, assert_same, gpu_that_clips, layer_of, read};
use crate::multiview::{alone, stages, with};
use crate::passes::{attach, clear, view_of};
use crate::pictures::lamp;
use crate::stage::{SIDE, Stage};
use host::gpu::Gpu;

/// A device, and what each view alone says: 255 in light, 0 in shadow.
fn lit() -> Option<(Gpu, Vec<Stage>, Vec<Vec<u8>>)> {
    // Whatever covers the screen reaches beyond it.
    let gpu = gpu_that_clips(wgpu::Features::empty())?;
    let stages = stages(lamp());
    let lit = |counts: &Vec<u8>| counts.iter().map(|&n| 255 * u8::from(n == 0)).collect();
    let right = alone(&gpu, &stages).iter().map(lit).collect();
    Some((gpu, stages, right))
}

/// Depth and stencil with the counts of a pass.
fn counted(pass: &Pass<'_>) -> wgpu::Texture {
    let depth = pass.target(pass.stages[0].format, 1);
    let mut renderer = pass.renderer();
    pass.prepare(&mut renderer, &[pass.light()]);
    pass.record(&mut renderer, &depth, None, |volumes, pass| {
        volumes.render(pass, 0, 0).unwrap();
    });
    depth
}

fn mask_of(pass: &Pass<'_>, counter: Counter) -> ShadowMask {
    let descriptor = ShadowMaskDescriptor {
        size: [SIDE; 2],
        lights: 2,
        multiview_mask: pass.multiview_mask(),
        counter,
        ..Default::default()
    };
    ShadowMask::new(&pass.gpu.device, &descriptor).unwrap()
}

#[test]
fn a_mask_has_a_layer_for_each_view_of_a_light() {
    let Some((gpu, stages, right)) = lit() else {
        return;
    };
    let pass = Pass::new(&gpu, 0b111, &stages);
    let depth = counted(&pass);
    let mask = mask_of(&pass, Counter::Stencil);
    gpu.checked(|| {
        gpu.run(|encoder| mask.encode(encoder, 1, &view_of(&depth)).unwrap());
    });
    let found = read(&gpu, mask.texture(), wgpu::TextureAspect::All);
    assert_same(&found[3..], &right, "the second light");
    assert!(
        found[0].iter().all(|&value| value == 0),
        "nothing of the first"
    );
}

#[test]
fn exact_counts_mark_the_stencil_and_fill_a_mask_in_each_view() {
    let Some((gpu, stages, right)) = lit() else {
        return;
    };
    if !gpu.support.float32_blending {
        eprintln!("skipped: no FLOAT32_BLENDABLE");
        return;
    }
    let stages = with(&stages, |stage| stage.savings.counter = Counter::Exact);
    let pass = Pass::new(&gpu, 0b111, &stages);
    let descriptor = ExactCountDescriptor {
        size: [SIDE; 2],
        depth_stencil_format: stages[0].format,
        multiview_mask: pass.multiview_mask(),
        ..Default::default()
    };
    let counts = ExactCount::new(&gpu.device, &descriptor).unwrap();
    let mask = mask_of(&pass, Counter::Exact);
    let depth = pass.target(stages[0].format, 1);
    let mut renderer = pass.renderer();
    pass.prepare(&mut renderer, &[pass.light()]);
    gpu.checked(|| {
        gpu.run(|encoder| {
            let depth_view = view_of(&depth);
            renderer.encode(encoder);
            pass.prepass(encoder, &depth);
            let mut counting = counts.begin(encoder, &depth_view).unwrap();
            // What was counted before is reset.
            renderer.render(&mut counting, 0, 0).unwrap();
            renderer.reset(&mut counting);
            renderer.render(&mut counting, 0, 0).unwrap();
            drop(counting);
            counts.encode(encoder, &depth_view).unwrap();
            mask.encode_counts(encoder, 1, &counts).unwrap();
        });
    });
    let marked = read(&gpu, &depth, wgpu::TextureAspect::StencilOnly);
    let lit = |marks: &Vec<u8>| marks.iter().map(|mark| 255 * (1 - mark)).collect();
    let marked: Vec<Vec<u8>> = marked.iter().map(lit).collect();
    assert_same(&marked, &right, "stencil");
    let found = read(&gpu, mask.texture(), wgpu::TextureAspect::All);
    assert_same(&found[3..], &right, "mask");
}

#[test]
fn light_is_joined_in_each_view_from_its_own_layers() {
    let Some((gpu, stages, right)) = lit() else {
        return;
    };
    let pass = Pass::new(&gpu, 0b111, &stages);
    let depth = counted(&pass);
    let format = wgpu::TextureFormat::R8Unorm;
    let descriptor = LightJoinDescriptor {
        color_format: format,
        multiview_mask: pass.multiview_mask(),
        ..Default::default()
    };
    let join = LightJoin::new(&gpu.device, &descriptor).unwrap();
    // Every layer is of another brightness.
    let filled = |first: u8| {
        let source = pass.target(format, 1);
        gpu.run(|encoder| {
            for layer in 0..source.depth_or_array_layers() {
                let view = layer_of(&source, layer);
                let value = f64::from(first + layer as u8) / 255.0;
                let color = wgpu::Color {
                    r: value,
                    ..wgpu::Color::BLACK
                };
                encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    color_attachments: &[Some(clear(&view, color, None))],
                    ..Default::default()
                });
            }
        });
        join.bind(&view_of(&source)).unwrap()
    };
    let [ambient, direct] = [40, 160].map(filled);
    let picture = pass.target(format, 1);
    gpu.checked(|| {
        gpu.run(|encoder| {
            let (color, depth) = (view_of(&picture), view_of(&depth));
            let mut joining = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(clear(&color, wgpu::Color::RED, None))],
                depth_stencil_attachment: Some(attach(&depth, None)),
                multiview_mask: pass.multiview_mask(),
                ..Default::default()
            });
            join.render_ambient(&mut joining, &ambient);
            join.render_lit(&mut joining, &direct);
        });
    });
    let joined = |(layer, lit): (u8, &Vec<u8>)| {
        let value = |lit: &u8| 40 + layer + (lit / 255) * (160 + layer);
        lit.iter().map(value).collect()
    };
    let right: Vec<Vec<u8>> = (0..).zip(&right).map(joined).collect();
    let found = read(&gpu, &picture, wgpu::TextureAspect::All);
    assert_same(&found, &right, "joined");
}
