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
    /// Those of the hard cases that have such a name are tried there.
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

/// What is tried where nothing else is asked for, of the hard cases' techniques: each kernel's way to compare,
/// each kind of map, each way to find silhouettes, both methods.
pub const NAMES: [&str; 10] = [
    "cube-hard",
    "cube-2x2",
    "cube-7x7",
    "cube-disk",
    "flat-2x2",
    "atlas-2x2",
    "volume-cpu",
    "volume-compute",
    "volume-vertex",
    "volume-zfail",
];

/// Draws everything and says how many were more wrong than they may be. The table is written after each variant:
/// all of them take long.
///
/// # Errors
/// If the device cannot do what a technique needs, or nothing can be written to `dir`.
pub fn run(gpu: &Gpu, plan: &Plan, command: &str, dir: &Path) -> Result<usize> {
    let cases: Vec<hard::cases::Case> = hard::cases::all().collect();
    let mut techniques = hard::techniques()?;
    techniques.retain(|all| plan.techniques.iter().any(|asked| asked.name == all.name));
    let steps = plan.variants.len() * (cases.len() * plan.rounds as usize + plan.scenes.len());
    let bar = progress(steps as u64, "arithmetic");
    let trials = Trials::new(gpu, plan, &cases, &techniques)?;
    let mut table = Table {
        driver: describe(&gpu.info),
        date: date::date(date::now()),
        command: command.into(),
        size: plan.size,
        rounds: plan.rounds,
        rows: Vec::new(),
    };
    for variant in &plan.variants {
        let row = trials.under(*variant, &bar);
        table.rows.push(row.with_context(|| variant.name)?);
        let files = vec![
            File::new("arithmetic.md", table.markdown()),
            File::new("arithmetic.json", format!("{:#}\n", table.json())),
        ];
        output::write(dir, files)?;
    }
    bar.finish_and_clear();
    let failures = table.failures();
    failures.iter().for_each(|failure| note(failure));
    say(&dir.join("arithmetic.md").display().to_string())?;
    Ok(failures.len())
}
