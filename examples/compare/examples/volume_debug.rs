//! Draws the debug views of shadow volumes as one picture:
//! `cargo run --release --example volume_debug -- --out docs/volume-debug.png`
//!
//! And the effect of `StartFrom`:
//! `cargo run --release --example volume_debug -- --start docs/volume-start.png`
//!
//! From the top left: the shaded scene; the volumes' surfaces and silhouette edges; stencil counts; casters
//! by the decision made for them. The eye is in the shadow of the sphere in front of it, which is why that
//! sphere is counted by z-fail, and why the sides of its volume (orange) are all around.

use std::f32::consts::PI;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use clap::Parser;
use compare::label::{self, band};
use compare::sheet::Sheet;
use host::gpu::Gpu;
use host::image::rgb_png;
use host::one_light::{OneLight, PrepareOne as _};
use host::renderer::{DEPTH, Renderer, SHADED, ShadowAccess, view};
use host::scene::{self, Mesh, Scene, homogeneous};
use host::scene_gpu::SceneGpu;
use host::terminal::say;
use shadows::glam::{Affine3A, Vec3, Vec4};
use shadows::{
    ShadowVolumeDescriptor, ShadowVolumeRenderer, StartFrom, VolumeDebug, VolumeDebugDescriptor,
    wgpu,
};

/// Pixels of a panel, below its words.
const SIZE: [u32; 2] = [640, 416];

/// Draws the debug views of shadow volumes as one picture.
#[derive(Parser)]
struct Args {
    /// The picture, a PNG.
    #[arg(long, default_value = "target/volume-debug.png")]
    out: PathBuf,
    /// Coarse spheres with smooth normals instead, their volumes starting from the light's side (left)
    /// and from the far side.
    #[arg(long, conflicts_with = "out")]
    start: Option<PathBuf>,
}

fn main() -> Result<()> {
    let args = Args::parse();
    let gpu = Gpu::new(None)?;
    if let Some(path) = args.start {
        let panel = |start| {
            let picture = Panels::new(&gpu, &coarse_spheres(), start)?.draw(|_| {});
            Ok(below(&format!("{start:?}"), picture))
        };
        let starts = [StartFrom::LightFacing, StartFrom::AwayFacing];
        let pictures: Vec<_> = starts.into_iter().map(panel).collect::<Result<_>>()?;
        return save(&path, &pictures);
    }
    let panels = Panels::new(&gpu, &scene(), StartFrom::LightFacing)?;
    let pictures = [
        below("shaded", panels.draw(|_| {})),
        below(
            "surfaces and silhouette edges",
            panels.draw(|pass| {
                panels
                    .debug
                    .draw_surfaces(pass, &panels.volumes, 0, 0)
                    .unwrap();
                panels
                    .debug
                    .draw_edges(pass, &panels.volumes, 0, 0)
                    .unwrap();
            }),
        ),
        below(
            "stencil counts",
            panels.draw(|pass| panels.debug.draw_counts(pass).expect("it has a stencil")),
        ),
        below(
            "methods",
            panels.draw(|pass| panels.debug.draw_casters(pass)),
        ),
    ];
    say(&format!("{:#?}", panels.volumes.statistics()))?;
    say(&format!("{:#?}", panels.volumes.survey(0, 0, SIZE)))?;
    save(&args.out, &pictures)
}

/// A panel below what it is.
fn below(words: &str, picture: Vec<[u8; 3]>) -> Vec<[u8; 3]> {
    [band(SIZE[0], words), picture].concat()
}

/// Writes panels, two in a row.
fn save(path: &Path, panels: &[Vec<[u8; 3]>]) -> Result<()> {
    let [width, height] = [SIZE[0], label::ROWS + SIZE[1]];
    let mut sheet = Sheet::new([2 * width, height * panels.len() as u32 / 2]);
    for (place, panel) in (0..).zip(panels) {
        sheet.put(panel, width, [place % 2 * width, place / 2 * height]);
    }
    let png = rgb_png(sheet.size, &sheet.pixels)?;
    std::fs::write(path, png).with_context(|| path.display().to_string())?;
    say(&path.display().to_string())
}

/// Two large spheres of few triangles.
fn coarse_spheres() -> Scene {
    let mut scene = scene::spheres();
    scene.meshes[1] = coarse_sphere(6);
    scene.objects.truncate(3);
    scene.light_mut().place = Vec4::new(-4.0, 5.0, 1.5, 1.0);
    scene.camera.eye = Vec3::new(0.0, 3.0, 6.5);
    scene.camera.target = Vec3::new(0.0, 0.9, 0.0);
    let places = [Vec3::new(-1.3, 1.2, 0.0), Vec3::new(1.6, 1.2, -0.5)];
    for (object, place) in scene.objects[1..].iter_mut().zip(places) {
        object.transform = Affine3A::from_translation(place);
    }
    scene
}

/// A unit sphere of `rings` by twice as many quads, its normals smooth.
fn coarse_sphere(rings: u32) -> Mesh {
    let columns = 2 * rings;
    let corner = |i: u32| {
        let row = i / columns;
        let (sine, height) = (PI * row as f32 / rings as f32).sin_cos();
        // The poles are one point each.
        let radius = if row.is_multiple_of(rings) { 0.0 } else { sine };
        let (z, x) = (2.0 * PI * (i % columns) as f32 / columns as f32).sin_cos();
        [radius * x, height, radius * z]
    };
    let positions: Vec<_> = (0..(rings + 1) * columns).map(corner).collect();
    let quad = |i: u32| {
        let (row, next) = (i / columns * columns, (i + 1) % columns);
        let [a, b] = [row + i % columns, row + next];
        [a, b, b + columns, a, b + columns, a + columns]
    };
    Mesh {
        name: "coarse sphere".into(),
        normals: positions.clone(),
        indices: (0..rings * columns).flat_map(quad).collect(),
        mask: Vec::new(),
        positions,
    }
}

/// A few spheres around a light of short range, one of them between the eye and the light.
fn scene() -> Scene {
    let mut scene = scene::spheres();
    scene.light_mut().range = 7.5;
    scene.camera.eye = Vec3::new(0.0, 8.0, 14.0);
    scene.camera.target = Vec3::new(0.0, 0.2, 0.5);
    let light = scene.light().place.truncate();
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
    fn new(gpu: &'a Gpu, scene: &Scene, start_from: StartFrom) -> Result<Self> {
        let scene_gpu = SceneGpu::new(gpu, scene)?;
        let renderer = Renderer::new(gpu, SIZE, scene, &scene_gpu)?;
        let mut volumes = ShadowVolumeRenderer::new(
            &gpu.device,
            &ShadowVolumeDescriptor {
                depth_stencil_format: renderer.depth_stencil_format(),
                depth: DEPTH,
                start_from,
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
        let view = view(scene, SIZE)?;
        let frame = OneLight {
            range: Some(scene.light().range),
            target_size: Some(SIZE),
            ..OneLight::new(&view, homogeneous(scene.light().place), &scene_gpu.casters)
        };
        volumes.prepare_one(&gpu.device, &gpu.queue, &frame)?;
        frame.with(|frame| debug.prepare(&gpu.device, frame, &volumes, 0, 0))?;
        gpu.run(|encoder| volumes.encode(encoder));
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
            smooth: true,
            ..Default::default()
        };
        let lit = self.renderer.lit_pipeline(self.gpu, &access);
        self.gpu.run(|encoder| {
            self.renderer.draw_ambient(encoder, &self.scene);
            self.volumes
                .render(&mut self.renderer.begin_stencil_pass(encoder), 0, 0)
                .expect("it is encoded");
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
