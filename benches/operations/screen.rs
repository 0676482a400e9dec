//! What stands between a count and the light: exact counts, masks and joins.

use anyhow::Result;
use shadows::{
    Counter, ExactCount, ExactCountDescriptor, LightJoin, LightJoinDescriptor, ShadowMask,
    ShadowMaskDescriptor, ShadowVolumeDescriptor, wgpu,
};

use crate::clock::Bench;
use crate::stage::{SIZE, Stage};
use crate::volume::Volumes;
use host::renderer::SHADED;

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let features = stage.gpu.device.features();
    match features.contains(wgpu::Features::FLOAT32_BLENDABLE) {
        true => exact(bench, stage)?,
        false => println!("ExactCount: this device does not blend 32-bit floats"),
    }
    mask(bench, stage)?;
    join(bench, stage)
}

fn exact(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    let descriptor = ExactCountDescriptor {
        size: SIZE,
        depth_stencil_format: stage.host.depth_stencil_format(),
        ..Default::default()
    };
    let new = |(): &mut ()| ExactCount::new(device, &descriptor);
    bench.cpu("exact count/ExactCount::new", &mut (), |()| {}, new);
    let counts = ExactCount::new(device, &descriptor)?;
    let options = ShadowVolumeDescriptor {
        counter: Counter::Exact,
        ..Default::default()
    };
    let mut volumes = Volumes::new(stage, options)?;
    let depth_stencil = stage.host.depth_stencil();
    let count = |volumes: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
        let mut pass = counts.begin(encoder, depth_stencil).expect("it fits");
        volumes
            .renderer
            .render(&mut pass, 0, 0)
            .expect("it is encoded");
    };
    bench.gpu("exact count/begin and render", &mut volumes, |_| {}, count);
    let mark = |_: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
        counts.encode(encoder, depth_stencil).expect("it fits");
    };
    bench.gpu("exact count/encode", &mut volumes, |_| {}, mark);
    Ok(())
}

/// A renderer whose volumes are counted in the host's stencil.
fn counted<'a>(stage: &'a Stage<'a>) -> Result<Volumes<'a>> {
    let volumes = Volumes::new(stage, Default::default())?;
    stage.gpu.run(|encoder| volumes.count(encoder));
    Ok(volumes)
}

fn mask(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    let descriptor = ShadowMaskDescriptor {
        size: SIZE,
        depth_stencil_format: stage.host.depth_stencil_format(),
        ..Default::default()
    };
    let new = |(): &mut ()| ShadowMask::new(device, &descriptor);
    bench.cpu("mask/ShadowMask::new", &mut (), |()| {}, new);
    let mask = ShadowMask::new(device, &descriptor)?;
    let copy = |_: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
        let depth_stencil = stage.host.depth_stencil();
        mask.encode(encoder, 0, depth_stencil).expect("it fits");
    };
    bench.gpu("mask/encode", &mut counted(stage)?, |_| {}, copy);
    Ok(())
}

fn join(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    let descriptor = LightJoinDescriptor {
        color_format: SHADED,
        depth_stencil_format: stage.host.depth_stencil_format(),
        ..Default::default()
    };
    let new = |(): &mut ()| LightJoin::new(device, &descriptor);
    bench.cpu("join/LightJoin::new", &mut (), |()| {}, new);
    let join = LightJoin::new(device, &descriptor)?;
    let source = stage.gpu.target(SIZE, SHADED, 1);
    let source = source.create_view(&Default::default());
    let bind = |(): &mut ()| join.bind(&source);
    bench.cpu("join/bind", &mut (), |()| {}, bind);
    let source = join.bind(&source)?;
    let mut volumes = counted(stage)?;
    let ambient = |_: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
        join.render_ambient(&mut stage.host.begin_overlay_pass(encoder), &source);
    };
    bench.gpu("join/render_ambient", &mut volumes, |_| {}, ambient);
    let lit = |_: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
        join.render_lit(&mut stage.host.begin_overlay_pass(encoder), &source);
    };
    bench.gpu("join/render_lit", &mut volumes, |_| {}, lit);
    Ok(())
}
