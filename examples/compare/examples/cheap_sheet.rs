//! The cheap and the baked techniques side by side, on a scene on which each can be right and on one on which it cannot:
//!
//! ```text
//! cargo run --release --all-features --example cheap_sheet -- docs/cheap.png
//! ```

use anyhow::{Context as _, Result, bail};
use compare::shadow::Shadow;
use compare::stage::Stage;
use host::gpu::Gpu;
use host::image::rgb_png;
use host::scene::{Scene, courtyard, floor};
use host::terminal::say;

/// One tile's pixels, below its label.
const TILE: [u32; 2] = [320, 180];
const LABEL: u32 = 15;
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
    let mut sheet = Sheet::new([
        COLUMNS * (TILE[0] + GAP) - GAP,
        rows * (LABEL + TILE[1] + GAP) - GAP,
    ]);
    let mut place = 0;
    for scene in scenes {
        let stage = Stage::new(&gpu, scene, TILE)?;
        for name in TECHNIQUES {
            let corner = [
                place % COLUMNS * (TILE[0] + GAP),
                place / COLUMNS * (LABEL + TILE[1] + GAP),
            ];
            sheet.write(&format!("{} {name}", stage.scene.name), corner)?;
            sheet.put(&shown(&gpu, &stage, name)?, [corner[0], corner[1] + LABEL]);
            place += 1;
        }
    }
    std::fs::write(path, rgb_png(sheet.size, &sheet.pixels)?)?;
    say(path)
}

fn shown(gpu: &Gpu, stage: &Stage, name: &str) -> Result<Vec<[u8; 3]>> {
    let row = compare::table::ROWS.iter().find(|row| row.name == name);
    let technique = row.context("no such technique")?.at(1024);
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique)?;
    Ok(stage.picture(gpu, &mut shadow, &stage.inputs)?.shaded)
}

/// White paper.
struct Sheet {
    size: [u32; 2],
    pixels: Vec<[u8; 3]>,
}

impl Sheet {
    fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            pixels: vec![[255; 3]; (size[0] * size[1]) as usize],
        }
    }

    fn put(&mut self, tile: &[[u8; 3]], [left, top]: [u32; 2]) {
        for (y, row) in (top..).zip(tile.chunks_exact(TILE[0] as usize)) {
            let at = (y * self.size[0] + left) as usize;
            self.pixels[at..at + row.len()].copy_from_slice(row);
        }
    }

    /// In black, from the corner of a label.
    fn write(&mut self, text: &str, [left, top]: [u32; 2]) -> Result<()> {
        for (x, letter) in (left + 2..).step_by(7).zip(text.chars()) {
            let glyph = glyph(letter).with_context(|| format!("no letter {letter:?}"))?;
            for (y, row) in (top + 3..).zip(glyph) {
                for column in (0..5).filter(|column| row >> (4 - column) & 1 == 1) {
                    self.pixels[(y * self.size[0] + x + column) as usize] = [0; 3];
                }
            }
        }
        Ok(())
    }
}

/// Nine rows of five pixels, the first on the left.
fn glyph(letter: char) -> Option<[u8; 9]> {
    let rows: [u8; 9] = match letter {
        ' ' => [0; 9],
        '-' => [0, 0, 0, 0, 0o16, 0, 0, 0, 0],
        'a' => [0, 0, 0o16, 0o01, 0o17, 0o21, 0o17, 0, 0],
        'b' => [0o20, 0o20, 0o36, 0o21, 0o21, 0o21, 0o36, 0, 0],
        'c' => [0, 0, 0o17, 0o20, 0o20, 0o20, 0o17, 0, 0],
        'd' => [0o01, 0o01, 0o17, 0o21, 0o21, 0o21, 0o17, 0, 0],
        'e' => [0, 0, 0o16, 0o21, 0o37, 0o20, 0o17, 0, 0],
        'f' => [0o06, 0o10, 0o36, 0o10, 0o10, 0o10, 0o10, 0, 0],
        'j' => [0o02, 0, 0o06, 0o02, 0o02, 0o02, 0o02, 0o22, 0o14],
        'k' => [0o20, 0o20, 0o22, 0o24, 0o30, 0o24, 0o22, 0, 0],
        'l' => [0o14, 0o04, 0o04, 0o04, 0o04, 0o04, 0o16, 0, 0],
        'm' => [0, 0, 0o32, 0o25, 0o25, 0o25, 0o25, 0, 0],
        'n' => [0, 0, 0o36, 0o21, 0o21, 0o21, 0o21, 0, 0],
        'o' => [0, 0, 0o16, 0o21, 0o21, 0o21, 0o16, 0, 0],
        'p' => [0, 0, 0o36, 0o21, 0o21, 0o21, 0o36, 0o20, 0o20],
        'r' => [0, 0, 0o26, 0o31, 0o20, 0o20, 0o20, 0, 0],
        's' => [0, 0, 0o17, 0o20, 0o16, 0o01, 0o36, 0, 0],
        't' => [0o10, 0o10, 0o36, 0o10, 0o10, 0o10, 0o06, 0, 0],
        'u' => [0, 0, 0o21, 0o21, 0o21, 0o21, 0o17, 0, 0],
        'v' => [0, 0, 0o21, 0o21, 0o21, 0o12, 0o04, 0, 0],
        'y' => [0, 0, 0o21, 0o21, 0o21, 0o21, 0o17, 0o01, 0o16],
        _ => return None,
    };
    Some(rows)
}
