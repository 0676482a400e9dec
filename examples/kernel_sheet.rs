//! Every kernel on the same shadows, as one picture: docs/kernels.png.
//!
//! ```text
//! cargo run --release --example kernel_sheet -- docs/kernels.png
//! ```

#[path = "host/mod.rs"]
mod host;
#[allow(dead_code)] // compare does more with them
#[path = "compare/shadow.rs"]
mod shadow;
#[allow(dead_code)]
#[path = "compare/stage.rs"]
mod stage;
#[allow(dead_code)]
#[path = "compare/table.rs"]
mod table;
#[allow(dead_code)]
#[path = "compare/technique.rs"]
mod technique;

use anyhow::{Context as _, Result};
use host::gpu::Gpu;
use host::scene::{Camera, courtyard};
use shadow::Shadow;
use shadows::glam::Vec3;
use shadows::reference::ReferenceImage;
use stage::Stage;

/// One tile's pixels.
const TILE: [u32; 2] = [312, 208];
const GAP: u32 = 4;
const COLUMNS: u32 = 4;
/// Texels of a face: few, so that kernels show.
const SIDE: u32 = 512;
/// Grey levels of the picture.
const LEVELS: u32 = 48;
/// In reading order; rays where there is no such technique.
const TILES: [&str; 12] = [
    "exact",
    "cube-hard",
    "cube-2x2",
    "cube-16",
    "cube-3x3",
    "cube-5x5",
    "cube-7x7",
    "cube-disk",
    "cube-disk-full",
    "cube-vogel",
    "cube-pcss",
    "area",
];

fn main() -> Result<()> {
    let path = std::env::args().nth(1);
    let path = path.context("name the file to write, such as docs/kernels.png")?;
    let gpu = Gpu::new(None)?;
    let mut scene = courtyard();
    scene.camera = Camera {
        eye: Vec3::new(-4.6, 5.9, 13.7),
        target: Vec3::new(2.35, 0.0, 5.75),
        fovy: 0.25,
        near: 0.1,
    };
    let stage = Stage::new(&gpu, scene, TILE)?;
    let reference = stage.reference(|_| ())?;
    let rows = (TILES.len() as u32).div_ceil(COLUMNS);
    let size = [
        COLUMNS * (TILE[0] + GAP) - GAP,
        rows * (TILE[1] + GAP) - GAP,
    ];
    let mut sheet = vec![255; (size[0] * size[1]) as usize];
    for (place, name) in (0..).zip(TILES) {
        let visibility = match name {
            "exact" => reference.visibility(),
            "area" => area(&reference),
            name => shown(&gpu, &stage, name)?,
        };
        let corner = [
            place % COLUMNS * (TILE[0] + GAP),
            place / COLUMNS * (TILE[1] + GAP),
        ];
        for y in 0..TILE[1] {
            for x in 0..TILE[0] {
                let value = u32::from(visibility[(y * TILE[0] + x) as usize]);
                let at = (corner[1] + y) * size[0] + corner[0] + x;
                // Few levels make a small file.
                let level = (value * (LEVELS - 1) + 127) / 255;
                sheet[at as usize] = (40 + level * 200 / (LEVELS - 1)) as u8;
            }
        }
    }
    std::fs::write(&path, host::image::grey_png(size, &sheet)?)?;
    host::terminal::say(&format!("{path}: {}", TILES.join(", ")))
}

fn shown(gpu: &Gpu, stage: &Stage, name: &str) -> Result<Vec<u8>> {
    let row = table::ROWS.iter().find(|row| row.name == name);
    let technique = row.context("no such technique")?.at(SIDE);
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique)?;
    Ok(stage.picture(gpu, &mut shadow, &stage.inputs)?.visibility)
}

/// A light of the size that `cube-pcss` is made for.
fn area(reference: &ReferenceImage) -> Vec<u8> {
    let pixels: Vec<[u32; 2]> = (0..TILE[0] * TILE[1])
        .map(|at| [at % TILE[0], at / TILE[0]])
        .collect();
    let radius = shadows::ContactHardening::default().light_size;
    let seen = reference.area_visibility(&pixels, radius.into(), 1024);
    seen.into_iter()
        .map(|part| (255.0 * part.unwrap_or(0.0)).round() as u8)
        .collect()
}
