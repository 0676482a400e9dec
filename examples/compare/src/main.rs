//! Renders scenes with every shadow technique, without a window, and measures error (against exact ray
//! casting), time and memory of each.
//!
//! ```text
//! cargo run --release --example compare -- --scene courtyard --out target/courtyard
//! ```

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use compare::{
    arithmetic, cost, growth, hard, measure, output, plot, scenes, soft, sweep, table, temporal,
};
use shadows::reference::ReferenceImage;

use compare::args::{self, Args};
use compare::lamps::Truth;
use compare::measure::Plan;
use compare::output::{File, Results};
use compare::progress::progress;
use compare::report::{LeftOut, Report};
use compare::stage::Stage;
use compare::sweep::Wishes;
use compare::technique::{Config, Technique};
use host::gpu::{Gpu, describe};
use host::scene::{self, LightKind, Scene};
use host::terminal::{note, say};

fn main() -> ExitCode {
    let args = args::parse();
    match run(&args) {
        Ok(code) => code,
        Err(error) => {
            let message = format!("{error:#}").replace(['\n', '\r'], " ");
            note(&format!("error: {message}"));
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

fn run(args: &Args) -> Result<ExitCode> {
    if args.hard_cases {
        let cases = hard::cases::chosen(&args.cases)?;
        let gpu = opened(args, [&args.out])?;
        return Ok(match hard::run(&gpu, &cases, &args.out, args.rounds)? {
            0 => ExitCode::SUCCESS,
            _ => ExitCode::FAILURE,
        });
    }
    if let Some(names) = &args.arithmetic {
        return other_arithmetic(args, names);
    }
    if let Some(times) = args.growth {
        let gpu = opened(args, [&args.out])?;
        growth::run(&gpu, times, args.frames, &args.out)?;
    } else if let Some(size) = args.temporal {
        temporal(args, size)?;
    } else if let Some(counts) = &args.cost {
        cost(args, counts)?;
    } else {
        each_scene(args)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The device, once it is sure that results can be written.
fn opened<'a>(args: &Args, dirs: impl IntoIterator<Item = &'a PathBuf>) -> Result<Gpu> {
    for dir in dirs {
        output::check(dir)?;
    }
    let gpu = Gpu::new(args.adapter.as_deref())?;
    note(&describe(&gpu.info));
    Ok(gpu)
}

fn each_scene(args: &Args) -> Result<()> {
    // Everything that can be wrong with what was asked comes before the first picture.
    let jobs: Vec<Job> = args
        .scene_dirs()
        .into_iter()
        .map(|(name, dir)| job(args, name, dir))
        .collect::<Result<_>>()?;
    let gpu = opened(args, jobs.iter().map(|job| &job.dir))?;
    let mut results = Vec::new();
    let mut reports = Vec::new();
    for job in jobs {
        let name = job.scene.name.clone();
        let (files, report) = compare(args, &gpu, job).with_context(|| format!("scene {name}"))?;
        results.push(files);
        reports.extend(report);
    }
    if reports.len() > 1 {
        results.push(Results {
            dir: args.out.clone(),
            files: vec![File::new("scenes.md", scenes::markdown(&reports))],
            report: "scenes.md",
            summary: "all scenes:".into(),
            export: None,
        });
    }
    // Written only now, so that a failure leaves nothing half done.
    output::write_all(&results)?;
    for result in &results {
        say(&result.summary)?;
        say(&result.dir.join(result.report).display().to_string())?;
    }
    Ok(())
}

fn temporal(args: &Args, size: [u32; 2]) -> Result<()> {
    let scenes = args.scene_dirs();
    let loaded: Vec<(Scene, PathBuf)> = scenes
        .into_iter()
        .map(|(name, dir)| Ok((asked_scene(args, name, size)?, dir)))
        .collect::<Result<_>>()?;
    let gpu = opened(args, loaded.iter().map(|(_, dir)| dir))?;
    let plan = temporal::Plan {
        techniques: &args.techniques,
        side: args.face,
        size,
        steps: args.steps,
    };
    for (scene, dir) in loaded {
        temporal::run(&gpu, &scene, &plan, &dir)
            .with_context(|| format!("scene {}", scene.name))?;
    }
    Ok(())
}

fn other_arithmetic(args: &Args, names: &[String]) -> Result<ExitCode> {
    let variants = arithmetic::variants(names)?;
    let techniques = match args.techniques.are_usual() {
        true => arithmetic::NAMES
            .iter()
            .map(|name| table::named(name, args.face))
            .collect::<Result<_>>()?,
        false => {
            let asked = args.techniques.0.iter();
            asked.map(|row| row.at(args.face)).collect()
        }
    };
    let scenes = args.scenes.iter();
    let plan = arithmetic::Plan {
        scenes: scenes
            .map(|name| asked_scene(args, name, args.size))
            .collect::<Result<_>>()?,
        techniques,
        size: args.size,
        rounds: args.rounds,
        variants,
    };
    let gpu = opened(args, [&args.out])?;
    let given: Vec<String> = std::env::args().skip(1).collect();
    let command = format!(
        "cargo run --release --example compare -- {}",
        given.join(" ")
    );
    Ok(match arithmetic::run(&gpu, &plan, &command, &args.out)? {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    })
}

fn cost(args: &Args, counts: &Path) -> Result<()> {
    let names = args.scenes.iter();
    let scenes: Vec<Scene> = names
        .map(|name| asked_scene(args, name, args.size))
        .collect::<Result<_>>()?;
    let gpu = opened(args, [&args.out])?;
    let files = cost::run(&gpu, counts, &scenes, args.size, args.face)?;
    output::write(&args.out, files)?;
    say(&args.out.join("cost-vs-error.md").display().to_string())
}

/// A scene with what the command line replaces in it.
fn asked_scene(args: &Args, name: &str, size: [u32; 2]) -> Result<Scene> {
    let ground = args.ground == args::Ground::Auto;
    let loaded = scene::load(name, ground, args.time);
    let mut scene = loaded.with_context(|| format!("scene {name}"))?;
    if !scene.left_out.is_empty() {
        note(&format!(
            "{name}: left out are {}",
            scene.left_out.join(", ")
        ));
    }
    scene.override_with(args.light, args.range, args.camera_override());
    if let Some(kind) = args.light_kind {
        let made = scene.shine_as(kind);
        made.with_context(|| format!("scene {name}: --light-kind"))?;
    }
    if args.range.is_some() && scene.light().kind() == LightKind::Directional {
        bail!("scene {name}: --range is of no use, a directional light has none");
    }
    // Who replaces the light has that one alone.
    let replaced = args.light.is_some() || args.range.is_some() || args.light_kind.is_some();
    let most = if replaced { 1 } else { scene.lights.len() };
    let wanted = match args.lights {
        Some(wanted) => wanted as usize,
        None if args.compares() => most.min(args::LIGHTS),
        None => 1,
    };
    if wanted > most {
        bail!("scene {name}: --lights {wanted} is too many, it has {most}");
    }
    scene.lights.truncate(wanted);
    host::renderer::view(&scene, size).with_context(|| format!("scene {name}: camera"))?;
    Ok(scene)
}

fn job(args: &Args, name: &str, dir: PathBuf) -> Result<Job> {
    let scene = asked_scene(args, name, args.size)?;
    let lights: Vec<LightKind> = scene.lights.iter().map(|light| light.kind()).collect();
    let asked: Vec<Technique> = match args.sweep {
        true => sweep::techniques(&args.techniques),
        false => args
            .techniques
            .0
            .iter()
            .map(|row| row.at(args.face))
            .collect(),
    };
    let masks = scene.casts_through_masks();
    let draws = |technique: &Technique| !masks || technique.config.draws_masks();
    let limit = |technique: &Technique| match draws(technique) {
        true => technique.config.limit(),
        false => "only the host can draw this scene's leaves, and it does so into maps alone",
    };
    let (techniques, others): (Vec<_>, Vec<_>) = asked.into_iter().partition(|technique| {
        let mut kinds = lights.iter();
        draws(technique) && kinds.any(|kind| technique.config.applies_to(*kind))
    });
    if let ([], [other, ..]) = (techniques.as_slice(), others.as_slice()) {
        bail!("no technique is left: {}", limit(other));
    }
    // The usual flat maps are for lights that are no points; where nobody asked for them, that is
    // nothing to tell.
    let unasked = args.techniques.are_usual() || args.sweep;
    let left_out: Vec<LeftOut> = others
        .into_iter()
        .filter(|other| !(unasked && matches!(other.config, Config::Flat { .. })))
        .map(|other| LeftOut {
            reason: limit(&other),
            name: other.name.into_owned(),
        })
        .collect();
    for left in &left_out {
        note(&format!("{} is left out: {}", left.name, left.reason));
    }
    Ok(Job {
        scene,
        dir,
        techniques,
        left_out,
    })
}

/// A scene's files, and what they say unless they are of a sweep.
fn compare(args: &Args, gpu: &Gpu, job: Job) -> Result<(Results, Option<Report>)> {
    let stage = Stage::new(gpu, job.scene, args.size)?;
    let name = &stage.scene.name;

    let bar = progress(1000, &format!("{name}: reference"));
    let shared = bar.clone();
    let truth = Truth::new(&stage, move |part| {
        shared.set_position((part * 1000.0) as u64)
    })?;
    bar.finish_and_clear();

    if args.sweep {
        let results = swept(args, gpu, &stage, truth.first(), job.techniques)?;
        let dir = job.dir;
        return Ok((Results { dir, ..results }, None));
    }
    let plan = Plan {
        techniques: &job.techniques,
        frames: args.frames,
        seed: args.seed,
    };
    let steps = u64::from(plan.frames) * plan.techniques.len() as u64;
    let bar = progress(steps, &format!("{name}: frames"));
    let mut measured = measure::measure(gpu, &stage, &truth, &plan, &|| bar.inc(1))?;
    bar.finish_and_clear();
    if truth.images.len() == 1 {
        soft::judge(gpu, &stage, truth.first(), &mut measured)?;
    }

    let report = Report::new(gpu, &stage, &truth, &measured, &job.left_out);
    let mut files = vec![
        File::new("report.json", report.json()?),
        File::new("report.md", report.markdown(gpu, args.export)),
        File::new(
            "speed-vs-error.svg",
            plot::speed_vs_error(&format!("{name}, {}", gpu.info.name), &measured)?,
        ),
    ];
    files.extend(output::pictures(args.size, &truth, &measured)?);
    let results = Results {
        dir: job.dir,
        files,
        report: "report.md",
        summary: report.summary(),
        export: args.export.then_some(stage.scene),
    };
    Ok((results, Some(report)))
}

fn swept(
    args: &Args,
    gpu: &Gpu,
    stage: &Stage,
    reference: &ReferenceImage,
    techniques: Vec<Technique>,
) -> Result<Results> {
    let name = &stage.scene.name;
    let rounds = args.frames as usize;
    let bar = progress(
        (techniques.len() * rounds) as u64,
        &format!("{name}: sweep"),
    );
    let swept = sweep::survey(gpu, stage, reference, techniques, rounds, &|| bar.inc(1))?;
    bar.finish_and_clear();
    let survey = &swept.survey;
    let wishes = Wishes {
        error_at_most: args.error_at_most,
        time_at_most: args.time_at_most,
    };
    let title = format!("{name}, {}", gpu.info.name);
    Ok(Results {
        dir: PathBuf::new(),
        files: vec![
            File::new(
                "sweep.md",
                sweep::markdown(&swept, &title, args.size, rounds, &wishes),
            ),
            File::new("sweep.json", sweep::json(survey)?),
            File::new("speed-vs-error.svg", plot::fronts(&title, survey)?),
        ],
        report: "sweep.md",
        summary: sweep::summary(survey, name, &wishes),
        export: None,
    })
}
