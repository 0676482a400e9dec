//! Every kernel on the same shadows, as one picture: docs/kernels.png. Or ours and other engines' in our
//! rendition, with what is wrong in colour (red: false light, blue: false shadow): docs/peers.png.
//!
//! ```text
//! cargo run --release --example kernel_sheet -- docs/kernels.png
//! cargo run --release --example kernel_sheet -- --peers docs/peers.png
//! ```

use anyhow::{Context as _, Result};
use compare::shadow::Shadow;
use compare::stage::Stage;
use host::gpu::Gpu;
use host::scene::{Camera, courtyard};
use shadows::glam::Vec3;
use shadows::reference::{Interior, ReferenceImage, Verdict};

/// One tile's pixels.
const TILE: [u32; 2] = [312, 208];
const GAP: u32 = 4;
const COLUMNS: u32 = 4;
/// Grey levels of the picture.
const LEVELS: u32 = 48;

/// What is shown of what.
struct Sheet {
    /// In reading order; rays where there is no such technique.
    tiles: &'static [&'static str],
    /// Texels of a face.
    side: u32,
    camera: Camera,
    /// Whether wrong pixels have a colour.
    errors: bool,
}

/// Few texels, so that kernels show.
const KERNELS: Sheet = Sheet {
    tiles: &[
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
    ],
    side: 512,
    camera: Camera {
        eye: Vec3::new(-4.6, 5.9, 13.7),
        target: Vec3::new(2.35, 0.0, 5.75),
        fovy: 0.25,
        near: 0.1,
    },
    errors: false,
};

const PEERS: Sheet = Sheet {
    tiles: &[
        "exact",
        "cube-2x2",
        "cube-hw",
        "cube-3x3",
        "cube-textbook",
        "peer-bevy-2x2",
        "peer-bevy-gaussian",
        "peer-three",
    ],
    side: 1024,
    camera: Camera {
        fovy: 0.13,
        target: Vec3::new(1.2, 0.3, 6.2),
        ..KERNELS.camera
    },
    errors: true,
};

fn main() -> Result<()> {
    let mut args: Vec<String> = std::env::args().skip(1).collect();
    let peers = args.first().is_some_and(|arg| arg == "--peers");
    let path = args.pop().filter(|path| !path.starts_with("--"));
    let path = path.context("name the file to write, such as docs/kernels.png")?;
    let sheet = if peers { PEERS } else { KERNELS };
    let gpu = Gpu::new(None)?;
    let mut scene = courtyard();
    scene.camera = sheet.camera;
    let stage = Stage::new(&gpu, scene, TILE)?;
    let reference = stage.reference(|_| ())?;
    let rows = (sheet.tiles.len() as u32).div_ceil(COLUMNS);
    let size = [
        COLUMNS * (TILE[0] + GAP) - GAP,
        rows * (TILE[1] + GAP) - GAP,
    ];
    let mut pixels = vec![[255; 3]; (size[0] * size[1]) as usize];
    for (place, name) in (0..).zip(sheet.tiles) {
        let visibility = match *name {
            "exact" => reference.visibility(),
            "area" => area(&reference),
            name => shown(&gpu, &stage, name, sheet.side)?,
        };
        let colors = tile(&reference, &visibility, sheet.errors)?;
        let corner = [
            place % COLUMNS * (TILE[0] + GAP),
            place / COLUMNS * (TILE[1] + GAP),
        ];
        for (y, row) in (0..).zip(colors.chunks_exact(TILE[0] as usize)) {
            let at = ((corner[1] + y) * size[0] + corner[0]) as usize;
            pixels[at..at + row.len()].copy_from_slice(row);
        }
    }
    let file = match sheet.errors {
        true => host::image::rgb_png(size, &pixels)?,
        false => {
            let grey: Vec<u8> = pixels.iter().map(|pixel| pixel[0]).collect();
            host::image::grey_png(size, &grey)?
        }
    };
    std::fs::write(&path, file)?;
    host::terminal::say(&format!("{path}: {}", sheet.tiles.join(", ")))
}

/// Visibility in few levels, which make a small file.
fn tile(reference: &ReferenceImage, visibility: &[u8], errors: bool) -> Result<Vec<[u8; 3]>> {
    let error = reference.compare(visibility, Interior::Screen)?;
    let exact = reference.visibility();
    let pixels = visibility.iter().zip(&exact).zip(&error.verdicts);
    Ok(pixels
        .map(|((&shown, &exact), verdict)| match verdict {
            Verdict::FalseLit | Verdict::FalseLitInterior if errors => [230, 40, 30],
            Verdict::FalseShadow | Verdict::FalseShadowInterior if errors => [40, 100, 240],
            _ => {
                // What faces away from the light is dark whatever a map says.
                let away = errors && *verdict == Verdict::NotCounted;
                let value = if away { exact } else { shown };
                let level = (u32::from(value) * (LEVELS - 1) + 127) / 255;
                [(40 + level * 200 / (LEVELS - 1)) as u8; 3]
            }
        })
        .collect())
}

fn shown(gpu: &Gpu, stage: &Stage, name: &str, side: u32) -> Result<Vec<u8>> {
    let row = compare::table::ROWS.iter().find(|row| row.name == name);
    let technique = row.context("no such technique")?.at(side);
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
