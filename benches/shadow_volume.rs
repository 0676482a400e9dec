//! What choosing costs and saves: the renderer's own choices beside the textbook's volumes, the price
//! of a caster that is skipped, and the search for silhouettes beside plain loops.
//!
//! On the scene `spheres`, 1280 x 720, per frame: prepare, extraction and stencil pass, in
//! interleaved rounds so that a machine that slows down slows both.
//! - `ratio auto_vs_textbook`: the default renderer over `ShadowVolumeDescriptor::textbook()`. Both
//!   are told the light's range, the target's size and the scene's bounds (and the textbook has no use
//!   for any of them).
//! - `ratio unbounded_vs_textbook`: the default renderer without the scene's bounds.
//! - `ratio zfail_vs_textbook`: the same with z-fail forced, so without what z-pass saves.
//! - `ratio infinite_vs_textbook`: the default with volumes that end at infinity.
//! - `ratio nothing_vs_textbook`: the pass without any caster, a floor that all of them stand on.
//!
//! Then the camera moves while light and casters stand still:
//! - `ratio extracted_vs_drawn`: silhouettes searched over casters drawn, which must be 0.
//!
//! Then `prepare` with ten thousand casters, all of them beside the view:
//! - `ratio skipped_vs_drawn`: a skipped caster over one that is drawn, both on the CPU.
//!
//! Then a closed mesh of a million triangles: `ratio extraction_vs_best_loop` and what else
//! `shadow_volume/extraction.rs` says.
//!
//! Then four thousand casters: `ratio distinct_meshes_4000_vs_one_mesh` and what else
//! `shadow_volume/distinct.rs` says.
//!
//! Then frames in which little changed: `ratio kept_vs_moving_prepare` and what else
//! `shadow_volume/kept.rs` says.
//!
//! Then what recording costs: `ratio record_1000_meshes_vs_10` and what else `shadow_volume/recording.rs`
//! says. `--extraction`, `--distinct`, `--kept` and `--recording` measure nothing but these.
//!
//! `--fill` measures nothing but what volumes fill: see `shadow_volume/fill.rs`.
//!
//! Each ratio is the median of the rounds' own. `prepare` is timed on the CPU, the rest between two
//! timestamps on a real GPU that has them, and elsewhere until the device is done; which, is printed.
//! `--quick` takes fewer rounds.

#[path = "shadow_volume/distinct.rs"]
mod distinct;
#[path = "shadow_volume/extraction.rs"]
mod extraction;
#[path = "shadow_volume/fill.rs"]
mod fill;
#[path = "shadow_volume/kept.rs"]
mod kept;
#[path = "shadow_volume/recording.rs"]
mod recording;
#[path = "shared/mod.rs"]
mod shared;

use std::time::Instant;

use host::gpu::Gpu;
use host::one_light::{OneLight, PrepareOne as _};
use host::renderer::{self, Renderer};
use host::scene::homogeneous;
use host::scene_gpu::SceneGpu;
use host::timer::Timer;
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::Bounds;
use shadows::{
    Caster, Extrusion, HomogeneousLight, Method, ShadowVolumeDescriptor, ShadowVolumeRenderer, View,
};
use shared::{median, paired};

const SIZE: [u32; 2] = [1280, 720];
const SKIPPED: usize = 10_000;

/// The scene, its targets and what a renderer is told.
struct Studio {
    gpu: Gpu,
    timer: Timer,
    host: Renderer,
    scene: SceneGpu,
    view: View,
    light: HomogeneousLight,
    range: Option<f32>,
    receivers: Bounds,
    /// A walk of the camera.
    walk: Vec<View>,
}

impl Studio {
    fn new(gpu: Gpu) -> anyhow::Result<Self> {
        let scene = host::scene::spheres();
        let scene_gpu = SceneGpu::new(&gpu, &scene)?;
        let light = homogeneous(scene.light().place);
        let all = scene.bounds();
        let receivers = Bounds {
            min: all.min.as_vec3(),
            max: all.max.as_vec3(),
        };
        Ok(Self {
            timer: Timer::new(&gpu),
            host: Renderer::new(&gpu, SIZE, &scene, &scene_gpu)?,
            view: renderer::view(&scene, SIZE)?,
            range: (!light.is_directional()).then_some(scene.light().range),
            receivers,
            walk: walk(&scene)?,
            scene: scene_gpu,
            light,
            gpu,
        })
    }

    fn volumes(&self, options: ShadowVolumeDescriptor<'_>) -> anyhow::Result<ShadowVolumeRenderer> {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: self.host.depth_stencil_format(),
            depth: renderer::DEPTH,
            ..options
        };
        Ok(ShadowVolumeRenderer::new(&self.gpu.device, &descriptor)?)
    }

    fn told<'a>(&self, view: &'a View, casters: &'a [Caster]) -> OneLight<'a> {
        OneLight {
            range: self.range,
            target_size: Some(SIZE),
            receivers: Some(self.receivers),
            ..OneLight::new(view, self.light, casters)
        }
    }

    fn prepare(&self, volumes: &mut ShadowVolumeRenderer, frame: &OneLight<'_>) -> f64 {
        let start = Instant::now();
        volumes
            .prepare_one(&self.gpu.device, &self.gpu.queue, frame)
            .expect("a sound frame");
        start.elapsed().as_secs_f64() * 1e3
    }

    /// Milliseconds of one frame's shadows.
    fn frame(&self, volumes: &mut ShadowVolumeRenderer, frame: &OneLight<'_>) -> f64 {
        self.gpu
            .run(|encoder| self.host.draw_ambient(encoder, &self.scene));
        let prepare = self.prepare(volumes, frame);
        prepare
            + self.timer.time(&self.gpu, |encoder| {
                volumes.encode(encoder);
                volumes
                    .render(&mut self.host.begin_stencil_pass(encoder), 0, 0)
                    .expect("it is encoded");
            })
    }

    /// Ten thousand casters of one mesh, each moved by an offset.
    fn crowd(&self, offset: Vec3) -> Vec<Caster> {
        let one = &self.scene.casters[0];
        let moved = |i: usize| {
            let place = offset + Vec3::new((i % 100) as f32, 0.0, (i / 100) as f32) * 1e-3;
            let transform = Affine3A::from_translation(place) * one.world_from_object;
            Caster::new(one.mesh.clone(), transform)
        };
        (0..SKIPPED).map(moved).collect()
    }
}

/// The scene's camera, a little farther along at every step.
fn walk(scene: &host::scene::Scene) -> anyhow::Result<Vec<View>> {
    let step = |i| {
        let mut scene = scene.clone();
        scene.camera.eye += Vec3::new(1.0, 0.3, -0.5) * i as f32;
        renderer::view(&scene, SIZE)
    };
    (0..10).map(step).collect()
}

/// Silhouettes searched, and casters drawn, after the first frame while only the camera moves.
fn extracted_on_the_walk(studio: &Studio) -> anyhow::Result<[u32; 2]> {
    let mut volumes = studio.volumes(ShadowVolumeDescriptor::default())?;
    let [mut extracted, mut drawn] = [0; 2];
    for (place, view) in studio.walk.iter().enumerate() {
        let frame = studio.told(view, &studio.scene.casters);
        studio.frame(&mut volumes, &frame);
        let found = volumes.statistics();
        if place > 0 {
            extracted += found.casters_extracted;
            drawn += found.casters_drawn;
        } else {
            assert!(found.casters_extracted > 0, "{found:?}");
        }
    }
    Ok([extracted, drawn])
}

/// Microseconds a caster on the CPU, round by round: skipped, and drawn.
fn skipped_and_drawn(studio: &Studio, rounds: usize) -> anyhow::Result<[Vec<f64>; 2]> {
    // Behind the camera, on the side away from the light: nothing of their shadows is in view.
    let [near, ..] = studio.view.near_corners();
    let behind = (near.as_vec3() - studio.light.xyzw().truncate()).normalize_or_zero() * 1e4;
    let crowds = [studio.crowd(behind), studio.crowd(Vec3::ZERO)];
    let mut renderers = [
        studio.volumes(ShadowVolumeDescriptor {
            label: Some("skipped"),
            ..Default::default()
        })?,
        studio.volumes(Default::default())?,
    ];
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..=rounds {
        for (place, crowd) in crowds.iter().enumerate() {
            // Another view each time, or nothing would have to be decided; without a range, or the range
            // would skip them before the view can.
            let view = &studio.walk[round % 2];
            let frame = OneLight::new(view, studio.light, crowd);
            let start = Instant::now();
            renderers[place].prepare_one(&studio.gpu.device, &studio.gpu.queue, &frame)?;
            let time = start.elapsed().as_secs_f64() * 1e6 / SKIPPED as f64;
            studio.gpu.run(|encoder| renderers[place].encode(encoder));
            if round > 0 {
                times[place].push(time);
            }
        }
    }
    let [skipped, drawn] = renderers.map(|renderer| renderer.statistics());
    assert_eq!(skipped.skipped_out_of_view as usize, SKIPPED, "{skipped:?}");
    assert_eq!(drawn.casters_drawn as usize, SKIPPED, "{drawn:?}");
    Ok(times)
}

fn main() -> anyhow::Result<()> {
    let rounds = if shared::quick() { 7 } else { 31 };
    let Ok(gpu) = Gpu::new(None) else {
        eprintln!("skipped: no adapter");
        return Ok(());
    };
    let asked = |name: &str| std::env::args().any(|argument| argument == name);
    let (only_distinct, only_extraction) = (asked("--distinct"), asked("--extraction"));
    if asked("--fill") {
        return fill::run(&gpu);
    }
    let (only_kept, only_recording) = (asked("--kept"), asked("--recording"));
    if only_distinct {
        distinct::run(&gpu, rounds.min(7));
    }
    if only_extraction {
        extraction::run(&gpu, rounds);
    }
    if only_kept {
        kept::run(&gpu, rounds);
    }
    if only_recording {
        recording::run(&gpu, rounds);
    }
    if only_distinct || only_extraction || only_kept || only_recording {
        return Ok(());
    }
    let studio = Studio::new(gpu)?;
    println!(
        "adapter {}, clock {} and the CPU's",
        host::gpu::describe(&studio.gpu.info),
        studio.timer.clock().name()
    );
    let mut contestants = [
        ("auto", studio.volumes(ShadowVolumeDescriptor::default())?),
        (
            "zfail",
            studio.volumes(ShadowVolumeDescriptor {
                method: Method::ZFail,
                ..Default::default()
            })?,
        ),
        (
            "infinite",
            studio.volumes(ShadowVolumeDescriptor {
                extrusion: Extrusion::Infinite,
                ..Default::default()
            })?,
        ),
        (
            "textbook",
            studio.volumes(ShadowVolumeDescriptor::textbook())?,
        ),
        (
            "unbounded",
            studio.volumes(ShadowVolumeDescriptor::default())?,
        ),
        (
            "nothing",
            studio.volumes(ShadowVolumeDescriptor::default())?,
        ),
    ];
    let mut times = [const { Vec::new() }; 6];
    for round in 0..=rounds {
        for ((name, volumes), times) in contestants.iter_mut().zip(&mut times) {
            let told = studio.told(&studio.view, &studio.scene.casters);
            let frame = match *name {
                "nothing" => OneLight {
                    casters: &[],
                    ..told
                },
                "unbounded" => OneLight {
                    receivers: None,
                    ..told
                },
                _ => told,
            };
            let time = studio.frame(volumes, &frame);
            if round > 0 {
                times.push(time);
            }
        }
    }
    for ((name, volumes), times) in contestants.iter().zip(&times) {
        let median = median(times.iter().copied());
        println!("{name}: {median:.2} ms; {:?}", volumes.statistics());
    }
    let [skipped, drawn] = skipped_and_drawn(&studio, rounds.min(7))?;
    println!(
        "a caster skipped {:.0} ns, drawn {:.0} ns, of {SKIPPED}",
        1e3 * median(skipped.iter().copied()),
        1e3 * median(drawn.iter().copied())
    );
    let [extracted, moved] = extracted_on_the_walk(&studio)?;
    println!("extracted {extracted} while the camera moves, drawn {moved}");
    extraction::run(&studio.gpu, rounds);
    distinct::run(&studio.gpu, rounds.min(7));
    kept::run(&studio.gpu, rounds);
    recording::run(&studio.gpu, rounds);
    let [auto, zfail, infinite, textbook, unbounded, nothing] = &times;
    for (name, ours) in [
        ("auto", auto),
        ("zfail", zfail),
        ("infinite", infinite),
        ("unbounded", unbounded),
        ("nothing", nothing),
    ] {
        println!("ratio {name}_vs_textbook {:.3}", paired(ours, textbook));
    }
    println!("ratio skipped_vs_drawn {:.3}", paired(&skipped, &drawn));
    println!(
        "ratio extracted_vs_drawn {:.3}",
        f64::from(extracted) / f64::from(moved)
    );
    Ok(())
}
