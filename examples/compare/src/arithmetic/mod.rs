//! `compare --arithmetic`: scenes and hard cases with the shaders' arithmetic as a driver may choose it.

pub mod bounds;
mod inline;
mod rebuild;
mod rules;
mod snap;
pub mod table;
pub mod trial;
pub mod variant;

use std::path::Path;

use anyhow::{Context as _, Result, ensure};

use self::table::Table;
use self::trial::Trials;
use self::variant::Variant;
use crate::date;
use crate::hard;
use crate::output::{self, File};
use crate::progress::progress;
use crate::technique::Technique;
use host::gpu::{Gpu, describe};
use host::scene::Scene;
use host::terminal::{note, say};

/// What is drawn under each variant.
pub struct Plan {
    pub variants: Vec<Variant>,
    pub scenes: Vec<Scene>,
    pub techniques: Vec<Technique>,
    /// Of the scenes' pictures.
    pub size: [u32; 2],
    /// Of the hard cases.
    pub rounds: u32,
}

/// The variants of these names, after the one that changes nothing; `all` for all.
///
/// # Errors
/// If there is none of a name.
pub fn variants(names: &[String]) -> Result<Vec<Variant>> {
    let mut chosen = vec![variant::ALL[0]];
    for name in names {
        let found: Vec<Variant> = match name.as_str() {
            "all" => variant::ALL.to_vec(),
            _ => Variant::named(name).into_iter().collect(),
        };
        let known = variant::ALL.map(|variant| variant.name).join(", ");
        ensure!(
            !found.is_empty(),
            "no arithmetic {name:?}; known are {known}, and all"
        );
        for variant in found {
            if !chosen.contains(&variant) {
                chosen.push(variant);
            }
        }
    }
    Ok(chosen)
}

/// Of the hard cases' techniques: each kernel's way to compare, each way to find silhouettes, both methods.
const NAMES: [&str; 7] = [
    "cube-hard",
    "cube-7x7",
    "cube-disk",
    "flat-2x2",
    "volume-compute",
    "volume-vertex",
    "volume-zfail",
];

/// The techniques that hard cases are tried with.
///
/// # Errors
/// If one has no row in the table of techniques.
pub fn techniques() -> Result<Vec<Technique>> {
    let mut all = hard::techniques()?;
    all.retain(|technique| NAMES.contains(&technique.name.as_ref()));
    Ok(all)
}

/// Draws everything, writes the table and says how many were more wrong than they may be.
///
/// # Errors
/// If the device cannot do what a technique needs, or nothing can be written to `dir`.
pub fn run(gpu: &Gpu, plan: &Plan, command: &str, dir: &Path) -> Result<usize> {
    let cases: Vec<hard::cases::Case> = hard::cases::all().collect();
    let techniques = techniques()?;
    let steps = plan.variants.len() * (cases.len() * plan.rounds as usize + plan.scenes.len());
    let bar = progress(steps as u64, "arithmetic");
    let trials = Trials::new(gpu, plan, &cases, &techniques)?;
    let rows = plan.variants.iter().map(|variant| {
        let row = trials.under(*variant, &bar);
        row.with_context(|| variant.name)
    });
    let rows = rows.collect::<Result<_>>()?;
    bar.finish_and_clear();
    let table = Table {
        driver: describe(&gpu.info),
        date: date::date(date::now()),
        command: command.into(),
        size: plan.size,
        rounds: plan.rounds,
        scenes: plan.scenes.iter().map(|scene| scene.name.clone()).collect(),
        rows,
    };
    let files = vec![
        File::new("arithmetic.md", table.markdown()),
        File::new("arithmetic.json", format!("{:#}\n", table.json())),
    ];
    output::write(dir, files)?;
    let failures = table.failures();
    failures.iter().for_each(|failure| note(failure));
    say(&dir.join("arithmetic.md").display().to_string())?;
    Ok(failures.len())
}
