//! `compare --temporal`: how much each technique shimmers while something moves a little.

mod path;
mod plot;
mod table;

use std::path::Path as Directory;

use anyhow::{Context as _, Result, bail};
use serde::Serialize;
use shadows::reference::{Flips, ReferenceImage};

use crate::args::Techniques;
use crate::output::{self, File};
use crate::progress::progress;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::technique::Technique;
use host::gpu::{Gpu, describe};
use host::scene::{LightKind, Scene};
use host::terminal::{note, say};

pub use path::Path;

/// What to watch.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    pub techniques: &'a Techniques,
    /// Texels along the side of a map.
    pub side: u32,
    pub size: [u32; 2],
    pub steps: u32,
}

/// Why a light map is not watched.
const ONE_LIGHT: &str = "a light map is of a light that stands, and here it moves";

impl Plan<'_> {
    /// What can be watched.
    fn asked(&self) -> Vec<Technique> {
        let rows = self.techniques.0.iter();
        let all = rows.map(|row| row.at(self.side));
        all.filter(|technique| !technique.config.is_of_one_light())
            .collect()
    }
}

/// A technique on all paths, under one light.
#[derive(Clone, Debug, Serialize)]
pub struct Watched {
    pub technique: String,
    /// point, spot or directional.
    pub light: &'static str,
    pub paths: Vec<Shimmer>,
}

/// What flipped on a path.
#[derive(Clone, Debug, Serialize)]
pub struct Shimmer {
    pub path: &'static str,
    /// Pixels that count, mean of the steps.
    pub pixels: f64,
    /// Of 10,000 pixels that count, mean of the steps: what the reference flips.
    pub of_reference: f64,
    /// The same for what flips although the reference does not.
    pub excess: f64,
    /// In the worst step.
    pub worst: f64,
    /// Those that change by more than half of full light.
    pub jumps: f64,
    /// Flips in excess, step by step, in pixels.
    pub steps: Vec<usize>,
}

impl Shimmer {
    fn new(path: Path, flips: &[Flips]) -> Self {
        let part = |count: usize, of: &Flips| 1e4 * count as f64 / of.pixels.max(1) as f64;
        let mean = |figure: &dyn Fn(&Flips) -> f64| {
            flips.iter().map(figure).sum::<f64>() / flips.len().max(1) as f64
        };
        let parts = flips.iter().map(|flips| part(flips.excess, flips));
        Self {
            path: path.name(),
            pixels: mean(&|flips| flips.pixels as f64),
            of_reference: mean(&|flips| part(flips.of_reference, flips)),
            excess: mean(&|flips| part(flips.excess, flips)),
            worst: parts.fold(0.0, f64::max),
            jumps: mean(&|flips| part(flips.jumps, flips)),
            steps: flips.iter().map(|flips| flips.excess).collect(),
        }
    }
}

/// Watches the techniques in a scene, and writes temporal.md, temporal.json and temporal.svg.
///
/// A point light is made a directional one, too, so that flat maps have something to do.
///
/// # Errors
/// If no technique can shadow the scene's light, the device cannot do what one needs, or a file cannot
/// be written.
pub fn run(gpu: &Gpu, scene: &Scene, plan: &Plan<'_>, out: &Directory) -> Result<()> {
    let kinds = kinds(scene.light().kind(), plan)?;
    let mut watched = Vec::new();
    for kind in kinds {
        let mut scene = scene.clone();
        scene.shine_as(kind)?;
        watched.extend(watch_all(gpu, scene, plan)?);
    }
    let title = format!("{}, {}", scene.name, describe(&gpu.info));
    let files = vec![
        File::new("temporal.md", table::markdown(&title, plan, &watched)),
        File::new(
            "temporal.json",
            serde_json::to_string_pretty(&watched)? + "\n",
        ),
        File::new("temporal.svg", plot::dots(&title, &watched)?),
    ];
    output::write(out, files)?;
    say(&out.join("temporal.md").display().to_string())
}

/// The kinds of light that the techniques are watched under: the scene's, and parallel light instead of
/// a point's. What applies to none is told.
fn kinds(own: LightKind, plan: &Plan<'_>) -> Result<Vec<LightKind>> {
    let mut kinds = vec![own];
    if own == LightKind::Point {
        kinds.push(LightKind::Directional);
    }
    let techniques = plan.asked();
    let (some, none): (Vec<_>, Vec<_>) = techniques.into_iter().partition(|technique| {
        let mut kinds = kinds.iter();
        kinds.any(|&kind| technique.config.applies_to(kind))
    });
    if some.is_empty() && none.is_empty() {
        bail!("no technique is left: {ONE_LIGHT}");
    }
    if some.is_empty() {
        bail!("no technique is left: {}", none[0].config.limit());
    }
    if !plan.techniques.are_usual() {
        for row in &plan.techniques.0 {
            if row.at(plan.side).config.is_of_one_light() {
                note(&format!("{} is left out: {ONE_LIGHT}", row.name));
            }
        }
        for other in none {
            note(&format!(
                "{} is left out: {}",
                other.name,
                other.config.limit()
            ));
        }
    }
    kinds.retain(|&kind| {
        some.iter()
            .any(|technique| technique.config.applies_to(kind))
    });
    Ok(kinds)
}

/// Every technique that can shadow the scene's light.
fn watch_all(gpu: &Gpu, scene: Scene, plan: &Plan<'_>) -> Result<Vec<Watched>> {
    let kind = scene.light().kind();
    let techniques = plan.asked().into_iter();
    let techniques: Vec<Technique> = techniques
        .filter(|technique| technique.config.applies_to(kind))
        .collect();
    let mut watched: Vec<Watched> = techniques
        .iter()
        .map(|technique| Watched {
            technique: technique.name.to_string(),
            light: kind.name(),
            paths: Vec::new(),
        })
        .collect();
    let mut stage = Stage::new(gpu, scene, plan.size)?;
    for path in Path::ALL {
        let references = references(gpu, &mut stage, path, plan.steps)?;
        let label = format!("{}: {} path", kind.name(), path.name());
        let bar = progress(techniques.len() as u64, &label);
        for (technique, watched) in techniques.iter().zip(&mut watched) {
            let flips = watch(gpu, &mut stage, technique, path, &references)
                .with_context(|| technique.name.to_string())?;
            watched.paths.push(Shimmer::new(path, &flips));
            bar.inc(1);
        }
        bar.finish_and_clear();
    }
    Ok(watched)
}

/// The truth at each place of a path, one more than there are steps.
///
/// # Errors
/// If the scene is broken.
pub fn references(
    gpu: &Gpu,
    stage: &mut Stage,
    path: Path,
    steps: u32,
) -> Result<Vec<ReferenceImage>> {
    let (start, exact) = (stage.scene.clone(), stage.reference_scene()?);
    let references = (0..=steps)
        .map(|step| {
            go(gpu, stage, &start, path, [step, steps])?;
            stage.reference_in(&exact)
        })
        .collect();
    go(gpu, stage, &start, path, [0, steps])?;
    references
}

/// What a technique flips in each step of a path, beyond its references.
///
/// # Errors
/// If the device cannot do what the technique needs.
pub fn watch(
    gpu: &Gpu,
    stage: &mut Stage,
    technique: &Technique,
    path: Path,
    references: &[ReferenceImage],
) -> Result<Vec<Flips>> {
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone())?;
    watch_with(gpu, stage, path, references, |stage, _| {
        Ok(stage.picture(gpu, &mut shadow, &stage.inputs)?.visibility)
    })
}

/// The same for anything that makes a picture of a step.
///
/// # Errors
/// What `picture` returns, or if it is no picture of the stage.
pub fn watch_with(
    gpu: &Gpu,
    stage: &mut Stage,
    path: Path,
    references: &[ReferenceImage],
    mut picture: impl FnMut(&Stage, usize) -> Result<Vec<u8>>,
) -> Result<Vec<Flips>> {
    let start = stage.scene.clone();
    let steps = references.len().saturating_sub(1) as u32;
    let mut before: Option<Vec<u8>> = None;
    let mut flips = Vec::new();
    for (step, reference) in references.iter().enumerate() {
        go(gpu, stage, &start, path, [step as u32, steps])?;
        let now = picture(stage, step)?;
        if let Some(before) = &before {
            let before = (&references[step - 1], before.as_slice());
            flips.push(reference.flips(&now, before, path.moved())?);
        }
        before = Some(now);
    }
    go(gpu, stage, &start, path, [0, steps])?;
    Ok(flips)
}

fn go(gpu: &Gpu, stage: &mut Stage, start: &Scene, path: Path, step: [u32; 2]) -> Result<()> {
    let [step, steps] = step;
    let place = path.place(start, stage.renderer.size()[1], step, steps);
    stage.move_to(gpu, place.camera, place.light, place.shift)
}
