//! Renders scenes with every shadow technique, without a window, and measures each against exact
//! ray casting: its error, its time, its memory.
//!
//! ```text
//! cargo run --release --example compare -- --scene courtyard --out target/courtyard
//! ```

mod args;
mod date;
#[path = "../host/mod.rs"]
mod host;
mod measure;
mod output;
mod plot;
mod report;
mod shadow;
mod stage;
mod table;
mod technique;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};

use crate::args::Args;
use crate::host::gpu::{Gpu, describe};
use crate::host::scene::{self, Scene};
use crate::measure::Plan;
use crate::output::{File, Results};
use crate::report::LeftOut;
use crate::stage::Stage;
use crate::technique::{Config, Technique};

fn main() -> ExitCode {
    let args = args::parse();
    match run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let message = format!("{error:#}").replace(['\n', '\r'], " ");
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// A scene, where its results go and what measures it.
struct Job {
    scene: Scene,
    dir: PathBuf,
    techniques: Vec<Technique>,
    left_out: Vec<LeftOut>,
}

fn run(args: &Args) -> Result<()> {
    // Everything that can be wrong with what was asked comes before the first picture.
    let jobs: Vec<Job> = args
        .scene_dirs()
        .into_iter()
        .map(|(name, dir)| job(args, name, dir))
        .collect::<Result<_>>()?;
    for job in &jobs {
        output::check(&job.dir)?;
    }
    let gpu = Gpu::new(args.adapter.as_deref())?;
    eprintln!("{}", describe(&gpu.info));
    let results: Vec<Results> = jobs
        .into_iter()
        .map(|job| {
            let name = job.scene.name.clone();
            compare(args, &gpu, job).with_context(|| format!("scene {name}"))
        })
        .collect::<Result<_>>()?;
    // Written only now, so that a failure leaves nothing half done.
    output::write_all(&results)?;
    for result in &results {
        println!("{}", result.summary);
        println!("{}", result.dir.join("report.md").display());
    }
    Ok(())
}

fn job(args: &Args, name: &str, dir: PathBuf) -> Result<Job> {
    let ground = args.ground == args::Ground::Auto;
    let mut scene = scene::load(name, ground)?;
    scene.override_with(args.light, args.range, args.camera_override());
    if let Some(kind) = args.light_kind {
        let made = scene.shine_as(kind);
        made.with_context(|| format!("scene {name}: --light-kind"))?;
    }
    host::renderer::view(&scene, args.size).with_context(|| format!("scene {name}: camera"))?;
    let light = scene.light_kind();
    let asked = args.techniques.0.iter().map(|row| row.at(args.face));
    let (techniques, others): (Vec<_>, Vec<_>) =
        asked.partition(|technique| technique.config.applies_to(light));
    if techniques.is_empty() {
        let reasons: Vec<&str> = others.iter().map(|other| other.config.limit()).collect();
        bail!("no technique is left: {}", reasons[0]);
    }
    // The usual flat maps are for lights that are no points; where nobody asked for them, that is
    // nothing to tell.
    let unasked = args.techniques.are_usual();
    let left_out: Vec<LeftOut> = others
        .into_iter()
        .filter(|other| !(unasked && matches!(other.config, Config::Flat { .. })))
        .map(|other| LeftOut {
            name: other.name.into_owned(),
            reason: other.config.limit(),
        })
        .collect();
    for left in &left_out {
        eprintln!("{} is left out: {}", left.name, left.reason);
    }
    Ok(Job {
        scene,
        dir,
        techniques,
        left_out,
    })
}

fn compare(args: &Args, gpu: &Gpu, job: Job) -> Result<Results> {
    let stage = Stage::new(gpu, job.scene, args.size)?;
    let name = &stage.scene.name;

    let bar = progress(1000, &format!("{name}: reference"));
    let shared = bar.clone();
    let reference = stage.reference(move |part| shared.set_position((part * 1000.0) as u64))?;
    bar.finish_and_clear();

    let plan = Plan {
        techniques: &job.techniques,
        frames: args.frames,
        seed: args.seed,
    };
    let steps = u64::from(plan.frames) * plan.techniques.len() as u64;
    let bar = progress(steps, &format!("{name}: frames"));
    let measured = measure::measure(gpu, &stage, &reference, &plan, &|| bar.inc(1))?;
    bar.finish_and_clear();

    let report = report::Report::new(gpu, &stage, &reference, &measured, &job.left_out);
    let mut files = vec![
        File::new("report.json", report.json()?),
        File::new("report.md", report.markdown(gpu, args.export)),
        File::new(
            "speed-vs-error.svg",
            plot::speed_vs_error(&format!("{name}, {}", gpu.info.name), &measured)?,
        ),
    ];
    files.extend(output::pictures(args.size, &reference, &measured)?);
    Ok(Results {
        dir: job.dir,
        files,
        summary: report.summary(),
        export: args.export.then_some(stage.scene),
    })
}

/// A bar on a terminal, nothing elsewhere.
fn progress(length: u64, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} [{bar:40}] {percent}% {eta}");
    ProgressBar::new(length)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        .with_message(what.to_owned())
}
