//! Draws the debug views of shadow volumes as one picture:
//! `cargo run --release --example volume_debug -- --out docs/volume-debug.png`
//!
//! From the top left: the shaded scene; the volumes' surfaces and silhouette edges; stencil counts;
//! casters by what was decided for them.

#[path = "host/mod.rs"]
mod host;

use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::Parser;
use host::gpu::Gpu;
use host::image::rgb_png;
use host::renderer::{DEPTH, Renderer, SHADED, ShadowAccess, view};
use host::scene::{self, Scene};
use host::scene_gpu::SceneGpu;
use shadows::glam::{Affine3A, Vec3};
use shadows::{
    HomogeneousLight, ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, VolumeDebug,
    VolumeDebugDescriptor, wgpu,
};

const SIZE: [u32; 2] = [400, 260];

/// Draws the debug views of shadow volumes as one picture.
#[derive(Parser)]
struct Args {
    /// The picture, a PNG.
    #[arg(long, default_value = "target/volume-debug.png")]
    out: PathBuf,
}

fn main() -> Result<()> {
    let args = Args::parse();
    let gpu = Gpu::new(None)?;
    let panels = Panels::new(&gpu)?;
    let pictures = [
        panels.draw(|_| {}),
        panels.draw(|pass| {
            panels.debug.draw_surfaces(pass, &panels.volumes);
            panels.debug.draw_edges(pass, &panels.volumes);
        }),
        panels.draw(|pass| panels.debug.draw_counts(pass)),
        panels.draw(|pass| panels.debug.draw_casters(pass)),
    ];
    let png = rgb_png([2 * SIZE[0], 2 * SIZE[1]], &sheet(&pictures))?;
    std::fs::write(&args.out, png).with_context(|| args.out.display().to_string())?;
    println!("{}", args.out.display());
    println!("{:#?}", panels.volumes.statistics());
    Ok(())
}

/// A few spheres around a light of short range, one of them between the eye and the light.
fn scene() -> Scene {
    let mut scene = scene::spheres();
    scene.range = 7.5;
    scene.camera.eye = Vec3::new(0.0, 8.0, 14.0);
    scene.camera.target = Vec3::new(0.0, 0.2, 0.5);
    let light = scene.light.truncate();
    scene.objects[1].transform = Affine3A::from_translation(scene.camera.eye.lerp(light, 0.5));
    scene
}

struct Panels<'a> {
    gpu: &'a Gpu,
    scene: SceneGpu,
    renderer: Renderer,
    volumes: ShadowVolumeRenderer,
    debug: VolumeDebug,
}

impl<'a> Panels<'a> {
    fn new(gpu: &'a Gpu) -> Result<Self> {
        let scene = scene();
        let scene_gpu = SceneGpu::new(gpu, &scene)?;
        let renderer = Renderer::new(gpu, SIZE, &scene, &scene_gpu)?;
        let mut volumes = ShadowVolumeRenderer::new(
            &gpu.device,
            &ShadowVolumeDescriptor {
                depth_stencil_format: renderer.depth_stencil_format(),
                depth: DEPTH,
                ..Default::default()
            },
        )?;
        let mut debug = VolumeDebug::new(
            &gpu.device,
            &VolumeDebugDescriptor {
                color_format: SHADED,
                depth_stencil_format: renderer.depth_stencil_format(),
                depth: DEPTH,
                ..Default::default()
            },
        )?;
        let view = view(&scene, SIZE)?;
        let frame = ShadowVolumeFrame {
            range: Some(scene.range),
            target_size: Some(SIZE),
            ..ShadowVolumeFrame::new(&view, HomogeneousLight(scene.light), &scene_gpu.casters)
        };
        volumes.prepare(&gpu.device, &gpu.queue, &frame)?;
        debug.prepare(&gpu.device, &frame, &volumes)?;
        Ok(Self {
            gpu,
            scene: scene_gpu,
            renderer,
            volumes,
            debug,
        })
    }

    /// The lit scene with something drawn over it.
    fn draw(&self, over: impl Fn(&mut wgpu::RenderPass<'_>)) -> Vec<[u8; 3]> {
        let access = ShadowAccess {
            stencil: Some(guardless()),
            ..Default::default()
        };
        let lit = self.renderer.lit_pipeline(self.gpu, &access);
        self.gpu.run(|encoder| {
            self.volumes.encode(encoder);
            self.renderer.draw_ambient(encoder, &self.scene);
            self.volumes
                .render(&mut self.renderer.begin_stencil_pass(encoder));
            self.renderer.draw_lit(encoder, &self.scene, &lit, None);
            over(&mut self.renderer.begin_overlay_pass(encoder));
        });
        self.renderer.read_shaded(self.gpu)
    }
}

/// The light pass's stencil without its guard, so that the counts are still there to be shown.
fn guardless() -> wgpu::StencilState {
    let mut state = ShadowVolumeRenderer::light_pass_stencil();
    state.front.pass_op = wgpu::StencilOperation::Keep;
    state.back.pass_op = wgpu::StencilOperation::Keep;
    state
}

/// Two panels beside two.
fn sheet(panels: &[Vec<[u8; 3]>; 4]) -> Vec<[u8; 3]> {
    let [width, height] = SIZE.map(|side| side as usize);
    let row = |y: usize| {
        let pair = 2 * (y / height);
        let from = y % height * width;
        [pair, pair + 1].map(|panel| &panels[panel][from..from + width])
    };
    (0..2 * height).flat_map(row).flatten().copied().collect()
}
