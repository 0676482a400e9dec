//! `compare --growth`: what shadows cost as scenes, lights, pictures and maps grow.

pub mod fit;
mod plot;
pub mod quantity;
mod report;
mod subject;

use std::path::Path;

use anyhow::{Context as _, Result};

use crate::measure::median;
use crate::output::{self, File};
use crate::progress::progress;
use host::gpu::{Gpu, describe};
use host::terminal::say;
use host::timer::Timer;

use fit::Fit;
use quantity::Quantity;
use subject::{KINDS, Kind, Place, Subject};

/// Seconds a technique may take at one point; then it gets no more than [`LEAST`] frames.
const PATIENCE: f64 = 3.0;
/// Frames that are measured in any case.
const LEAST: usize = 3;

/// A technique's cost at each amount.
pub struct Curve {
    pub kind: Kind,
    /// Milliseconds on the CPU, medians.
    pub prepare: Vec<(f64, f64)>,
    /// Milliseconds on the GPU, medians.
    pub work: Vec<(f64, f64)>,
}

impl Curve {
    /// How fast the two grow.
    pub fn fits(&self) -> [Option<Fit>; 2] {
        [&self.prepare, &self.work].map(|points| fit::upper(points))
    }

    /// How fast what comes on top of their first points grows; `None` where that is next to nothing.
    pub fn added(&self) -> [Option<Fit>; 2] {
        [&self.prepare, &self.work].map(|points| fit::added(points))
    }
}

/// One quantity that was made to grow.
pub struct Series {
    pub quantity: Quantity,
    pub curves: Vec<Curve>,
}

/// Measures all quantities up to `times` their start, and writes growth.md, growth.json and a plot
/// each.
///
/// # Errors
/// If the device cannot do what is needed, or a file cannot be written.
pub fn run(gpu: &Gpu, times: f64, rounds: u32, out: &Path) -> Result<()> {
    let timer = Timer::new(gpu);
    let series: Vec<Series> = Quantity::ALL
        .into_iter()
        .map(|quantity| {
            let series = grow(gpu, &timer, quantity, times, rounds as usize);
            series.with_context(|| quantity.name())
        })
        .collect::<Result<_>>()?;
    let title = describe(&gpu.info);
    let mut files = vec![
        File::new(
            "growth.md",
            report::markdown(&title, timer.clock(), rounds, &series),
        ),
        File::new("growth.json", report::json(&title, timer.clock(), &series)?),
    ];
    for one in &series {
        let name = format!("growth-{}.svg", one.quantity.name());
        files.push(File::new(
            name,
            plot::curves(&gpu.info.name, timer.clock(), one)?,
        ));
    }
    output::write(out, files)?;
    say(&out.join("growth.md").display().to_string())
}

/// Rounds over all amounts and techniques, each round beginning with another.
fn grow(gpu: &Gpu, timer: &Timer, quantity: Quantity, times: f64, rounds: usize) -> Result<Series> {
    let sizes = quantity.series(times);
    let kinds = KINDS
        .into_iter()
        .filter(|kind| quantity.concerns(kind.is_map));
    let kinds: Vec<Kind> = kinds.collect();
    let places: Vec<Place> = sizes
        .iter()
        .map(|&size| Place::new(gpu, quantity.situation(size)))
        .collect::<Result<_>>()?;
    let mut subjects = Vec::new();
    for place in &places {
        for &kind in &kinds {
            subjects.push((place, Subject::new(gpu, place, kind)?));
        }
    }
    let count = subjects.len();
    let bar = progress((count * rounds) as u64, quantity.name());
    for round in 0..rounds {
        for turn in 0..count {
            let (place, subject) = &mut subjects[(round + turn) % count];
            if subject.spent < PATIENCE || subject.work.len() < LEAST {
                subject.measure(gpu, place, timer, quantity.reads())?;
            }
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    let amounts: Vec<f64> = sizes.iter().map(|&size| quantity.amount(size)).collect();
    let curve = |(place, kind): (usize, Kind)| {
        let at = |of: fn(&Subject) -> &[f64]| -> Vec<(f64, f64)> {
            let own = subjects.iter().skip(place).step_by(kinds.len());
            let medians = own.map(|(_, subject)| median(of(subject)));
            amounts.iter().copied().zip(medians).collect()
        };
        Curve {
            kind,
            prepare: at(|subject| &subject.prepare),
            work: at(|subject| &subject.work),
        }
    };
    Ok(Series {
        quantity,
        curves: kinds.iter().copied().enumerate().map(curve).collect(),
    })
}
