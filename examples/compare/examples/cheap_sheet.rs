//! The cheap and the baked techniques side by side, in a scene where each can be correct and in one where none can:
//!
//! ```text
//! cargo run --release --all-features --example cheap_sheet -- docs/cheap.png
//! ```

use anyhow::{Result, bail};
use compare::label::{self, band};
use compare::shadow::Shadow;
use compare::sheet::Sheet;
use compare::stage::Stage;
use compare::table;
use host::gpu::Gpu;
use host::image::rgb_png;
use host::scene::{Scene, courtyard, floor};
use host::terminal::say;

/// One tile's pixels, below its label.
const TILE: [u32; 2] = [320, 180];
const GAP: u32 = 4;
const COLUMNS: u32 = 3;

/// The first is right on both.
const TECHNIQUES: [&str; 6] = [
    "volume",
    "planar",
    "planar-soft",
    "projected",
    "blob",
    "baked",
];

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [path] = args.as_slice() else {
        bail!("name the file to write");
    };
    let gpu = Gpu::new(None)?;
    let scenes: [Scene; 2] = [floor(), courtyard()];
    let rows = (scenes.len() * TECHNIQUES.len()) as u32 / COLUMNS;
    let [across, down] = [TILE[0] + GAP, label::ROWS + TILE[1] + GAP];
    let mut sheet = Sheet::new([COLUMNS * across - GAP, rows * down - GAP]);
    let mut place = 0;
    for scene in scenes {
        let stage = Stage::new(&gpu, scene, TILE)?;
        for name in TECHNIQUES {
            let words = format!("{} {name}", stage.scene.name);
            let tile = [band(TILE[0], &words), shown(&gpu, &stage, name)?].concat();
            let corner = [place % COLUMNS * across, place / COLUMNS * down];
            sheet.put(&tile, TILE[0], corner);
            place += 1;
        }
    }
    std::fs::write(path, rgb_png(sheet.size, &sheet.pixels)?)?;
    say(path)
}

fn shown(gpu: &Gpu, stage: &Stage, name: &str) -> Result<Vec<[u8; 3]>> {
    let mut shadow = Shadow::new(gpu, &stage.renderer, table::named(name, 1024)?)?;
    Ok(stage.picture(gpu, &mut shadow, &stage.inputs)?.shaded)
}
