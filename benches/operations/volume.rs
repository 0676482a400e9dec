//! Shadow volumes of the 64 spheres by each way to find silhouettes.

use anyhow::Result;
use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::Vec3;
use shadows::{
    Caster, HomogeneousLight, Method, ShadowVolumeDescriptor, ShadowVolumeRenderer, Silhouettes,
    wgpu,
};

use crate::clock::Bench;
use crate::stage::{SIZE, Stage};
use host::renderer::DEPTH;
use host::scene::moved_light;

/// A renderer and its frame.
pub struct Volumes<'a> {
    stage: &'a Stage<'a>,
    pub renderer: ShadowVolumeRenderer,
    light: HomogeneousLight,
    casters: Vec<Caster>,
}

impl<'a> Volumes<'a> {
    /// With its volumes found. Formats and convention are the host's.
    pub fn new(stage: &'a Stage<'a>, options: ShadowVolumeDescriptor<'_>) -> Result<Self> {
        let descriptor = with_formats(stage, options);
        let renderer = ShadowVolumeRenderer::new(&stage.gpu.device, &descriptor)?;
        let mut volumes = Self {
            stage,
            renderer,
            light: stage.light(),
            casters: stage.casters(),
        };
        volumes.prepare();
        volumes.encode();
        Ok(volumes)
    }

    pub fn frame(&self) -> OneLight<'_> {
        told(self.stage, self.light, &self.casters)
    }

    pub fn prepare(&mut self) {
        let gpu = self.stage.gpu;
        let frame = told(self.stage, self.light, &self.casters);
        self.renderer
            .prepare_one(&gpu.device, &gpu.queue, &frame)
            .expect("the frame is in range");
    }

    pub fn encode(&mut self) {
        self.stage.gpu.run(|encoder| self.renderer.encode(encoder));
    }

    /// Counts in the host's stencil.
    pub fn count(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = self.stage.host.begin_stencil_pass(encoder);
        self.renderer
            .render(&mut pass, 0, 0)
            .expect("it is encoded");
    }

    /// The light, so that all silhouettes are searched.
    pub fn move_light(&mut self) {
        self.light = moved_light(self.light, Vec3::X * 1e-4);
    }
}

fn with_formats<'a>(
    stage: &Stage<'_>,
    options: ShadowVolumeDescriptor<'a>,
) -> ShadowVolumeDescriptor<'a> {
    ShadowVolumeDescriptor {
        depth_stencil_format: stage.host.depth_stencil_format(),
        depth: DEPTH,
        ..options
    }
}

fn told<'a>(stage: &'a Stage<'_>, light: HomogeneousLight, casters: &'a [Caster]) -> OneLight<'a> {
    OneLight {
        range: Some(stage.scene.light().range),
        target_size: Some(SIZE),
        receivers: Some(stage.receivers),
        ..OneLight::new(&stage.view, light, casters)
    }
}

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let ways = [
        ("CPU", Silhouettes::Cpu),
        ("compute", Silhouettes::Compute),
        ("vertex", Silhouettes::Vertex),
    ];
    for (name, silhouettes) in ways {
        let options = ShadowVolumeDescriptor {
            silhouettes,
            ..Default::default()
        };
        if let Err(missing) = way(bench, stage, name, options) {
            println!("volumes, {name}: {missing:#}");
        }
    }
    let forced = [
        (
            "z-fail",
            ShadowVolumeDescriptor {
                method: Method::ZFail,
                ..Default::default()
            },
        ),
        ("textbook", ShadowVolumeDescriptor::textbook()),
    ];
    for (name, options) in forced {
        render(bench, &mut Volumes::new(stage, options)?, name);
    }
    questions(bench, &mut Volumes::new(stage, Default::default())?);
    Ok(())
}

/// What moves before a frame.
type Move = fn(&mut Volumes<'_>);

fn way(
    bench: &mut Bench<'_>,
    stage: &Stage<'_>,
    name: &str,
    options: ShadowVolumeDescriptor<'_>,
) -> Result<()> {
    let descriptor = with_formats(stage, options);
    let new = |(): &mut ()| ShadowVolumeRenderer::new(&stage.gpu.device, &descriptor);
    let bench_name = format!("volumes/ShadowVolumeRenderer::new, {name}");
    bench.cpu(&bench_name, &mut (), |()| {}, new);
    let mut volumes = Volumes::new(stage, options)?;
    let moved: [(&str, Move); 2] = [
        ("light moving", |volumes| volumes.move_light()),
        ("still", |_| {}),
    ];
    for (how, moving) in moved {
        let before = |volumes: &mut Volumes<'_>| {
            volumes.encode();
            moving(volumes);
        };
        let bench_name = format!("volumes/prepare, {name}, {how}");
        bench.cpu(&bench_name, &mut volumes, before, Volumes::prepare);
    }
    // The other ways have nothing to record.
    if name == "compute" {
        let before = |volumes: &mut Volumes<'_>| {
            volumes.move_light();
            volumes.prepare();
        };
        let encode = |volumes: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
            volumes.renderer.encode(encoder);
        };
        bench.gpu(
            "volumes/encode, compute, light moving",
            &mut volumes,
            before,
            encode,
        );
    }
    volumes.prepare();
    volumes.encode();
    render(bench, &mut volumes, name);
    Ok(())
}

/// The stencil pass.
fn render(bench: &mut Bench<'_>, volumes: &mut Volumes<'_>, name: &str) {
    let draw = |volumes: &mut Volumes<'_>, encoder: &mut wgpu::CommandEncoder| {
        volumes.count(encoder);
    };
    bench.gpu(&format!("volumes/render, {name}"), volumes, |_| {}, draw);
}

/// What a renderer can be asked about its frame.
fn questions(bench: &mut Bench<'_>, volumes: &mut Volumes<'_>) {
    let survey = |volumes: &mut Volumes<'_>| volumes.renderer.survey(0, 0, SIZE);
    bench.cpu("volumes/survey", volumes, |_| {}, survey);
    let before = |volumes: &mut Volumes<'_>| {
        volumes.move_light();
        volumes.prepare();
        volumes.encode();
    };
    let bound = |volumes: &mut Volumes<'_>| volumes.renderer.count_bound(0, 0);
    bench.cpu("volumes/count_bound, light moving", volumes, before, bound);
    let wrap = |volumes: &mut Volumes<'_>| volumes.renderer.may_wrap(0, 0);
    bench.cpu("volumes/may_wrap, still", volumes, |_| {}, wrap);
}
