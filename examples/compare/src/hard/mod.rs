//! `compare --hard-cases`: where shadows usually break, every technique, against the reference.

pub mod atlas;
pub mod cases;
pub mod causes;
pub mod cheap;
pub mod course;
pub mod expect;
pub mod input;
pub mod judge;
pub mod limits;
pub mod outcome;
pub mod seams;
pub mod situation;
pub mod small;
pub mod table;
pub mod trial;

use std::path::Path;

use anyhow::Result;
use shadows::{CubeShadowMapDescriptor, MapSettings, wgpu};

use self::cases::Case;
use self::expect::{is_software, way};
use self::table::Table;
use self::trial::Trial;
use crate::date;
use crate::output::{self, File};
use crate::progress::progress;
use crate::table::{named, volume};
use crate::technique::{Config, Technique};
use host::gpu::{Gpu, describe};
use host::image::rgb_png;
use host::terminal::{note, say};

/// Of the pictures, in pixels.
pub const SIZE: [u32; 2] = [320, 240];
/// Texels along a map's side.
const SIDE: u32 = 512;
/// The named techniques that are tried.
const NAMES: [&str; 17] = [
    "cube-hard",
    "cube-2x2",
    "cube-hw",
    "cube-7x7",
    "cube-disk",
    "cube-textbook",
    "flat-2x2",
    "flat-hw",
    "flat-disk",
    "atlas-2x2",
    "volume",
    "volume-cpu",
    "volume-compute",
    "volume-vertex",
    "volume-zfail",
    "volume-exact-count",
    "volume-textbook",
];
/// The other kernels of an atlas, for what an atlas goes through.
const ATLAS_NAMES: [&str; 4] = ["atlas-hard", "atlas-hw", "atlas-5x5", "atlas-disk"];
/// The cheap and baked ones, where a case names them.
const CHEAP_NAMES: [&str; 5] = ["planar", "planar-soft", "projected", "blob", "baked"];
/// With a map of 16 bits; only where that is what is tried.
const SIXTEEN_BITS: &str = "cube-2x2-16-bit";
/// With finer maps, so many texels along a side; only where that is what is tried.
const FINE: [(&str, &str, u32); 2] = [
    ("cube-2x2", "cube-2x2-2048", 2048),
    ("flat-2x2", "flat-2x2-4096", 4096),
];

/// Tries some cases, or all and bad input as well, in so many rounds, writes the table, and says how many should have passed and
/// did not.
///
/// # Errors
/// If the device cannot do what a technique needs, or nothing can be written to `dir`.
pub fn run(gpu: &Gpu, cases: &[Case], dir: &Path, rounds: u32) -> Result<usize> {
    let techniques = techniques()?;
    let of_all = cases.len() == cases::all().count();
    let bar = progress(cases.len() as u64 * u64::from(rounds), "hard cases");
    let row = |case: &Case| {
        let (techniques, limits) = (techniques.as_slice(), [].as_slice());
        Trial {
            gpu,
            case,
            techniques,
            limits,
        }
        .run(rounds, &bar)
    };
    let rows = cases.iter().map(row).collect::<Result<_>>()?;
    bar.finish_and_clear();
    let table = Table {
        driver: describe(&gpu.info),
        date: date::date(date::now()),
        command: command((!of_all).then_some(cases), dir, rounds),
        size: SIZE,
        rounds,
        techniques: techniques.iter().map(|t| t.name.to_string()).collect(),
        way: format!("{:?}", way(&volume(), is_software(gpu))),
        rows,
        refusals: match of_all {
            true => input::refusals(gpu)?,
            false => Vec::new(),
        },
    };
    write(&table, dir)?;
    let failures = table.failures();
    failures.iter().for_each(|failure| note(failure));
    say(&dir.join("hard-cases.md").display().to_string())?;
    Ok(failures.len())
}

fn write(table: &Table, dir: &Path) -> Result<()> {
    let (size, sheet) = table.sheet();
    let files = vec![
        File::new("hard-cases.md", table.markdown()),
        File::new("hard-cases.png", rgb_png(size, &sheet)?),
        File::new("hard-cases.json", format!("{:#}\n", table.json())),
    ];
    output::write(dir, files)
}

/// What was asked for, as one would ask again.
fn command(some: Option<&[Case]>, dir: &Path, rounds: u32) -> String {
    let cases = some.unwrap_or_default().iter();
    let cases: String = cases.map(|of| format!("--case {:?} ", of.name)).collect();
    let dir = dir.display();
    format!(
        "cargo run --release --example compare -- --hard-cases {cases}--rounds {rounds} --out {dir}"
    )
}

/// All that are tried.
///
/// # Errors
/// If one has no row in the table of techniques.
pub fn techniques() -> Result<Vec<Technique>> {
    let of_this_side = |name| named(name, SIDE);
    let mut all: Vec<Technique> = NAMES.into_iter().map(of_this_side).collect::<Result<_>>()?;
    if let Config::Cube { map, sampler } = crate::table::cube(SIDE, Default::default()) {
        let format = wgpu::TextureFormat::Depth16Unorm;
        all.push(Technique {
            name: SIXTEEN_BITS.into(),
            config: Config::Cube {
                map: CubeShadowMapDescriptor {
                    settings: MapSettings {
                        format,
                        ..map.settings
                    },
                    ..map
                },
                sampler,
            },
        });
    }
    for (name, fine, side) in FINE {
        all.push(Technique {
            name: fine.into(),
            ..named(name, side)?
        });
    }
    for name in ATLAS_NAMES.into_iter().chain(CHEAP_NAMES) {
        all.push(of_this_side(name)?);
    }
    Ok(all)
}
