//! How soft edges look: kernels against a light with a size, and what of them is noise or bands.

use std::fmt::Write as _;

use anyhow::Result;
use serde::Serialize;
use shadows::reference::ReferenceImage;
use shadows::{ContactHardening, Kernel};

use crate::measure::Measured;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::technique::Config;
use host::gpu::Gpu;
use host::scene::Scene;

/// Pixels looked at, each with its neighbour on the right.
const PAIRS: usize = 512;
/// Rays a pixel.
const SAMPLES: u32 = 1024;
/// Of visibility: what a change must exceed the truth's by to count as a flip.
const FLIP: f64 = 0.05;

/// Over pixels in the penumbrae, in visibility (0 to 1).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Soft {
    /// Of the light that is the truth here; world units, or a directional light's tangent.
    pub light_radius: f64,
    pub pixels: usize,
    /// Against the light: root mean square, and largest difference.
    pub area_rmse: f64,
    pub area_largest: f64,
    /// How many values there are.
    pub levels: usize,
    /// How much larger a step to the next pixel is than the truth's, at most: banding.
    pub largest_step: f64,
    /// Standard deviation from pixel to pixel beyond the truth's.
    pub noise: f64,
    /// Pixels that change more than the truth when the camera moves by a tenth of a pixel.
    pub flips_percent: f64,
}

/// What is true and what is shown at the pairs, a pair's pixels one after the other.
struct Values<'a> {
    truth: &'a [f64],
    shown: &'a [f64],
}

/// Judges the techniques whose kernels make soft edges.
///
/// # Errors
/// If the device cannot do what a technique needs.
pub fn judge(
    gpu: &Gpu,
    stage: &Stage,
    reference: &ReferenceImage,
    measured: &mut [Measured],
) -> Result<()> {
    let candidates = pairs(reference, measured);
    if candidates.is_empty() {
        return Ok(());
    }
    let size = stage.renderer.size();
    let moved = Stage::new(gpu, moved(&stage.scene, size), size)?;
    let moved_reference = moved.reference(|_| ())?;
    let radius = f64::from(ContactHardening::default().light_size);
    let truth =
        |reference: &ReferenceImage| reference.area_visibility(&candidates, radius, SAMPLES);
    let (here, there) = (truth(reference), truth(&moved_reference));
    // Pairs that all four answers are known of.
    let known: Vec<usize> = (0..candidates.len())
        .step_by(2)
        .filter(|&at| (at..at + 2).all(|at| here[at].is_some() && there[at].is_some()))
        .flat_map(|at| [at, at + 1])
        .collect();
    let pick =
        |truth: &[Option<f64>]| -> Vec<f64> { known.iter().filter_map(|&at| truth[at]).collect() };
    let (here, there) = (pick(&here), pick(&there));
    let shown = |visibility: &[u8]| -> Vec<f64> {
        let places = known.iter().map(|&at| candidates[at]);
        places
            .map(|[x, y]| f64::from(visibility[(y * size[0] + x) as usize]) / 255.0)
            .collect()
    };
    for one in measured.iter_mut().filter(|one| is_soft(one)) {
        let mut shadow = Shadow::new(gpu, &moved.renderer, one.technique.clone())?;
        let after = moved.picture(gpu, &mut shadow, &moved.inputs)?;
        let before = Values {
            truth: &here,
            shown: &shown(&one.picture.visibility),
        };
        let after = Values {
            truth: &there,
            shown: &shown(&after.visibility),
        };
        one.soft = Some(Soft::new(radius, &before, &after));
    }
    Ok(())
}

fn is_soft(measured: &Measured) -> bool {
    if let Config::Survey(survey) = &measured.technique.config {
        return survey.is_soft();
    }
    let kernel = measured.technique.config.kernel();
    kernel.is_some_and(|kernel| {
        let weighted = matches!(
            kernel,
            Kernel::Weighted3 | Kernel::Weighted5 | Kernel::Weighted7
        );
        weighted || kernel.uses_pixel()
    })
}

/// Pixels where some soft technique shows neither light nor shadow, each followed by its neighbour,
/// evenly from all over the picture.
fn pairs(reference: &ReferenceImage, measured: &[Measured]) -> Vec<[u32; 2]> {
    let width = reference.width() as usize;
    let faces: Vec<bool> = reference
        .classes()
        .map(|class| class.faces_light())
        .collect();
    let in_between = |at: usize| {
        let soft = measured.iter().filter(|one| is_soft(one));
        soft.into_iter()
            .any(|one| (8..248).contains(&one.picture.visibility[at]))
    };
    let found: Vec<usize> = (0..faces.len())
        .filter(|at| at % width + 1 < width && faces[*at] && faces[at + 1] && in_between(*at))
        .collect();
    let place = |at: usize| [(at % width) as u32, (at / width) as u32];
    let step = found.len().div_ceil(PAIRS).max(1);
    let chosen = found.into_iter().step_by(step);
    chosen.flat_map(|at| [place(at), place(at + 1)]).collect()
}

/// The scene with its camera a tenth of a pixel to the right, seen at its target.
fn moved(scene: &Scene, size: [u32; 2]) -> Scene {
    let mut moved = scene.clone();
    let camera = &mut moved.camera;
    let forward = camera.target - camera.eye;
    let right = forward.cross(shadows::glam::Vec3::Y).normalize();
    let pixel = 2.0 * (0.5 * camera.fovy).tan() * forward.length() / size[1] as f32;
    camera.eye += 0.1 * pixel * right;
    camera.target += 0.1 * pixel * right;
    moved
}

impl Soft {
    fn new(light_radius: f64, before: &Values<'_>, after: &Values<'_>) -> Self {
        let pixels = before.shown.len();
        let errors = || before.shown.iter().zip(before.truth).map(|(a, b)| a - b);
        let beyond: Vec<f64> = steps(before.shown)
            .zip(steps(before.truth))
            .map(|(shown, truth)| shown - truth)
            .collect();
        let larger = steps(before.shown)
            .zip(steps(before.truth))
            .map(|(shown, truth)| shown.abs() - truth.abs());
        let flips = (0..pixels).filter(|&at| {
            let shown = (after.shown[at] - before.shown[at]).abs();
            let truth = (after.truth[at] - before.truth[at]).abs();
            shown > truth + FLIP
        });
        let mut levels = [false; 256];
        for value in before.shown {
            levels[(value * 255.0).round() as usize] = true;
        }
        Self {
            light_radius,
            pixels,
            area_rmse: root_mean_square(errors()),
            area_largest: errors().fold(0.0, |largest, error| error.abs().max(largest)),
            levels: levels.iter().filter(|level| **level).count(),
            largest_step: larger.fold(0.0, f64::max),
            noise: root_mean_square(beyond.into_iter()) / 2.0_f64.sqrt(),
            flips_percent: 100.0 * flips.count() as f64 / pixels.max(1) as f64,
        }
    }
}

/// The figures as Markdown; nothing if there are none.
pub fn write_table(out: &mut String, rows: &[(&str, Soft)]) -> std::fmt::Result {
    let Some((_, first)) = rows.first() else {
        return Ok(());
    };
    writeln!(
        out,
        "Soft edges, at {} pixels of the penumbrae, in visibility (0 to 1) against a light of \
         radius {:.2} ({SAMPLES} rays a pixel): root mean square and largest difference; how many \
         values are shown; the largest step to the next pixel beyond the light's (banding); noise \
         beyond it; pixels that change by {FLIP} more than it when the camera moves by a tenth of \
         a pixel.\n\n\
         | technique | RMSE | largest | levels | largest step | noise | flips |\n\
         |---|--:|--:|--:|--:|--:|--:|",
        first.pixels, first.light_radius
    )?;
    for (name, soft) in rows {
        writeln!(
            out,
            "| `{name}` | {:.3} | {:.2} | {} | {:.2} | {:.3} | {:.2} % |",
            soft.area_rmse,
            soft.area_largest,
            soft.levels,
            soft.largest_step,
            soft.noise,
            soft.flips_percent
        )?;
    }
    writeln!(out)
}

/// From a pair's first pixel to its second.
fn steps(values: &[f64]) -> impl Iterator<Item = f64> + '_ {
    values.chunks_exact(2).map(|pair| pair[1] - pair[0])
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, n), v| (sum + v * v, n + 1));
    (sum / count.max(1) as f64).sqrt()
}
