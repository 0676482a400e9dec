//! `compare --cost FILE`: what a receiver costs on a GPU, counted (`benches/shader_cost`), against how
//! wrong it is. No time is taken, so the machine does not matter.

mod counts;
mod plot;
mod report;

use std::path::Path;

use anyhow::{Context as _, Result};
use shadows::reference::Comparison;
use shadows::{Kernel, PcfSampler};

use self::counts::{Count, Counts};
use crate::measure::percent;
use crate::output::File;
use crate::progress::progress;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::table;
use crate::technique::{Config, Technique};
use host::gpu::{Gpu, describe};
use host::peers::PEERS;
use host::pipelines::{visibility_module, visibility_module_with_normals};
use host::scene::{LightKind, Scene};
use host::terminal::note;

/// The kinds of light, each with maps of its own.
const LIGHTS: [LightKind; 3] = [LightKind::Point, LightKind::Spot, LightKind::Directional];

/// A receiver by its name in the counts.
struct Entry {
    name: String,
    config: Config,
    /// Its call, if it is the library's.
    module: fn(&PcfSampler) -> String,
    count: Count,
}

/// What was found about one receiver under one kind of light, scene by scene.
struct Found {
    name: String,
    count: Count,
    /// Whether it is another engine's, or the textbook's.
    other: bool,
    errors: Vec<Comparison>,
}

/// What was found under one kind of light.
struct Lit {
    light: LightKind,
    found: Vec<Found>,
}

/// Everything that the page and the picture say.
struct Costs {
    driver: String,
    scenes: Vec<String>,
    size: [u32; 2],
    side: u32,
    lit: Vec<Lit>,
    /// What the library does not make, and why.
    left_out: Vec<String>,
}

/// Measures every receiver of the counts on the scenes, and gives the files that say it.
///
/// # Errors
/// If the counts lack a receiver, or the device cannot do it.
pub fn run(
    gpu: &Gpu,
    counts: &Path,
    scenes: &[Scene],
    size: [u32; 2],
    side: u32,
) -> Result<Vec<File>> {
    let counts = Counts::read(counts)?;
    let mut left_out = Vec::new();
    let mut lit = Vec::new();
    for light in LIGHTS {
        let entries = entries(&counts, light, side)?;
        let found = under(gpu, scenes, light, size, entries, &mut left_out)?;
        lit.push(Lit { light, found });
    }
    let costs = Costs {
        driver: describe(&gpu.info),
        scenes: scenes.iter().map(|scene| scene.name.clone()).collect(),
        size,
        side,
        lit,
        left_out,
    };
    Ok(vec![
        File::new("cost-vs-error.md", report::markdown(&costs)?),
        File::new("cost-vs-error.json", report::json(&costs)?),
        File::new("cost-vs-error.svg", plot::svg(&costs)?),
    ])
}

/// The receivers for a kind of light: every kernel, its plane's normal given, and the peers.
fn entries(counts: &Counts, light: LightKind, side: u32) -> Result<Vec<Entry>> {
    let (way, make): (_, fn(u32, Kernel) -> Config) = match light {
        LightKind::Point => ("cube", table::cube),
        LightKind::Spot | LightKind::Directional => ("flat", table::flat),
    };
    let mut entries = Vec::new();
    for kernel in Kernel::ALL {
        let name = format!("{way}/{}", counts::kernel_name(kernel));
        entries.push(Entry {
            count: counts.of(&format!("{name}/normal"))?,
            name,
            config: make(side, kernel),
            module: visibility_module_with_normals,
        });
    }
    if light == LightKind::Point {
        let name = "cube-linear/textbook".to_owned();
        entries.push(Entry {
            count: counts.of(&name)?,
            name,
            config: table::named("cube-textbook", side)?.config,
            module: visibility_module,
        });
    }
    for peer in &PEERS {
        let config = Config::Peer { peer, size: side };
        if !config.applies_to(light) {
            continue;
        }
        let name = format!("peer/{}", peer.name);
        entries.push(Entry {
            count: counts.of(&name)?,
            name,
            config,
            module: visibility_module,
        });
    }
    Ok(entries)
}

fn under(
    gpu: &Gpu,
    scenes: &[Scene],
    light: LightKind,
    size: [u32; 2],
    entries: Vec<Entry>,
    left_out: &mut Vec<String>,
) -> Result<Vec<Found>> {
    let mut found: Vec<Found> = entries
        .iter()
        .map(|entry| Found {
            name: entry.name.clone(),
            count: entry.count,
            other: matches!(entry.config, Config::Peer { .. }) || entry.name.ends_with("/textbook"),
            errors: Vec::new(),
        })
        .collect();
    for scene in scenes {
        let mut scene = scene.clone();
        let name = scene.name.clone();
        scene
            .shine_as(light)
            .with_context(|| format!("scene {name}"))?;
        let stage = Stage::new(gpu, scene, size)?;
        let label = format!("{name}, {}", light.name());
        let bar = progress(entries.len() as u64 + 1, &label);
        let reference = stage.reference(|_| ())?;
        bar.inc(1);
        for (entry, found) in entries.iter().zip(&mut found) {
            let technique = Technique {
                name: entry.name.clone().into(),
                config: entry.config.clone(),
            };
            match Shadow::read_by(gpu, &stage.renderer, technique, entry.module) {
                Ok(mut shadow) => {
                    let picture = stage.picture(gpu, &mut shadow, &stage.inputs)?;
                    let error = reference.compare(&picture.visibility, shadow.interior())?;
                    found.errors.push(error);
                }
                Err(reason) if found.errors.is_empty() => {
                    let reason = format!("`{}`: {reason:#}", entry.name);
                    note(&reason);
                    if !left_out.contains(&reason) {
                        left_out.push(reason);
                    }
                }
                Err(reason) => return Err(reason),
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
    }
    found.retain(|found| found.errors.len() == scenes.len());
    Ok(found)
}

impl Found {
    /// Wrong pixels in per cent of those that face the light, in a scene.
    fn wrong(&self, scene: usize) -> f64 {
        let error = &self.errors[scene];
        percent(error.false_lit + error.false_shadow, error)
    }

    /// Whether one of `others` costs no more of either kind of instruction, is no more wrong in the
    /// first scene, and better in one of the three.
    fn is_beaten_by(&self, others: &[Found]) -> bool {
        let of = |found: &Found| {
            (
                found.count.valu as f64,
                found.count.texture as f64,
                found.wrong(0),
            )
        };
        let own = of(self);
        others
            .iter()
            .map(of)
            .any(|other| other.0 <= own.0 && other.1 <= own.1 && other.2 <= own.2 && other != own)
    }
}
