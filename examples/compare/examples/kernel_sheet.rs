//! The same shadows by several techniques, as one picture:
//!
//! ```text
//! cargo run --release --example kernel_sheet -- --kernels docs/kernels.png        every kernel
//! cargo run --release --example kernel_sheet -- --peers docs/peers.png            ours and other engines'
//! cargo run --release --example kernel_sheet -- --difference docs/difference.png  close-ups: textbook, ours
//! ```
//!
//! In the last two wrong pixels have a colour: red where light is false, blue where shadow is. Above each
//! picture stands what it is.

use anyhow::{Result, bail};
use compare::label::{self, band};
use compare::shadow::Shadow;
use compare::sheet::Sheet;
use compare::stage::Stage;
use compare::table;
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

/// Tiles in reading order.
struct Plan {
    tiles: Vec<Tile>,
    /// Texels of a face.
    side: u32,
    /// Whether wrong pixels have a colour.
    errors: bool,
}

struct Tile {
    camera: Camera,
    /// A technique's, or `exact` or `area` for rays.
    name: &'static str,
    /// What stands above it.
    words: String,
}

const EYE: Vec3 = Vec3::new(-4.6, 5.9, 13.7);

/// A part of the courtyard, from where the whole of it is seen.
const fn close_up(target: Vec3, fovy: f32) -> Camera {
    Camera {
        eye: EYE,
        target,
        fovy,
        near: 0.1,
    }
}

const CHAINS: Camera = close_up(Vec3::new(2.35, 0.0, 5.75), 0.25);
const LINKS: Camera = close_up(Vec3::new(1.2, 0.3, 6.2), 0.13);

/// Links of a chain, a bollard's foot, the fence where three faces of the cube meet, and the flank of the
/// stairs, along which the light falls.
const CLOSE_UPS: [(Camera, &str); COLUMNS as usize] = [
    (close_up(Vec3::new(1.55, 0.5, 5.2), 0.04), "a chain"),
    (close_up(Vec3::new(2.75, 0.08, 5.0), 0.05), "a contact"),
    (close_up(Vec3::new(-3.45, 0.05, 4.8), 0.07), "a seam"),
    (close_up(Vec3::new(5.9, 1.2, -0.3), 0.07), "a grazed wall"),
];

fn of_one_view(camera: Camera, techniques: &[(&'static str, &str)]) -> Vec<Tile> {
    let tiles = techniques.iter().map(|&(name, words)| Tile {
        camera,
        name,
        words: words.into(),
    });
    tiles.collect()
}

/// Close-ups of one technique.
fn close_ups(&(name, words): &(&'static str, &'static str)) -> [Tile; COLUMNS as usize] {
    CLOSE_UPS.map(|(camera, what)| Tile {
        camera,
        name,
        words: format!("{words}: {what}"),
    })
}

fn plan(kind: &str) -> Result<Plan> {
    Ok(match kind {
        // Few texels, so that kernels show.
        "--kernels" => Plan {
            tiles: of_one_view(
                CHAINS,
                &[
                    ("exact", "exact"),
                    ("cube-hard", "Hard"),
                    ("cube-2x2", "Bilinear"),
                    ("cube-16", "FourTaps"),
                    ("cube-3x3", "Weighted3"),
                    ("cube-5x5", "Weighted5"),
                    ("cube-7x7", "Weighted7"),
                    ("cube-disk", "RandomDisk"),
                    ("cube-disk-full", "RandomDisk, no early-out"),
                    ("cube-vogel", "Vogel"),
                    ("cube-pcss", "ContactHardening"),
                    ("area", "a light of radius 0.1"),
                ],
            ),
            side: 512,
            errors: false,
        },
        "--peers" => Plan {
            tiles: of_one_view(
                LINKS,
                &[
                    ("exact", "exact"),
                    ("cube-2x2", "Bilinear"),
                    ("cube-hw", "HardwareBilinear"),
                    ("cube-3x3", "Weighted3"),
                    ("cube-textbook", "textbook"),
                    ("peer-bevy-2x2", "Bevy, 2x2"),
                    ("peer-bevy-gaussian", "Bevy, Gaussian"),
                    ("peer-three", "three.js"),
                ],
            ),
            side: 1024,
            errors: true,
        },
        "--difference" => Plan {
            tiles: [
                ("cube-textbook", "textbook"),
                ("cube-2x2", "map"),
                ("volume", "volumes"),
            ]
            .iter()
            .flat_map(close_ups)
            .collect(),
            side: 1024,
            errors: true,
        },
        other => bail!("{other} is none of --kernels, --peers, --difference"),
    })
}

/// One camera's stage and what is exact there.
struct View {
    camera: Camera,
    stage: Stage,
    reference: ReferenceImage,
}

impl View {
    fn new(gpu: &Gpu, camera: Camera) -> Result<Self> {
        let mut scene = courtyard();
        scene.camera = camera;
        let stage = Stage::new(gpu, scene, TILE)?;
        let reference = stage.reference(|_| ())?;
        Ok(Self {
            camera,
            stage,
            reference,
        })
    }
}

/// The place of a camera's view, which is made where there is none.
fn view_of(gpu: &Gpu, views: &mut Vec<View>, camera: Camera) -> Result<usize> {
    if let Some(place) = views.iter().position(|view| view.camera == camera) {
        return Ok(place);
    }
    views.push(View::new(gpu, camera)?);
    Ok(views.len() - 1)
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [kind, path] = args.as_slice() else {
        bail!("say --kernels, --peers or --difference, and the file to write");
    };
    let plan = plan(kind)?;
    let gpu = Gpu::new(None)?;
    let rows = (plan.tiles.len() as u32).div_ceil(COLUMNS);
    let [across, down] = [TILE[0] + GAP, label::ROWS + TILE[1] + GAP];
    let mut sheet = Sheet::new([COLUMNS * across - GAP, rows * down - GAP]);
    let mut views = Vec::new();
    for (place, shown_as) in (0..).zip(&plan.tiles) {
        let view = view_of(&gpu, &mut views, shown_as.camera)?;
        let View {
            stage, reference, ..
        } = &views[view];
        let visibility = match shown_as.name {
            "exact" => reference.visibility(),
            "area" => area(reference),
            name => shown(&gpu, stage, name, plan.side)?,
        };
        let colors = [
            band(TILE[0], &shown_as.words),
            tile(reference, &visibility, plan.errors)?,
        ]
        .concat();
        let corner = [place % COLUMNS * across, place / COLUMNS * down];
        sheet.put(&colors, TILE[0], corner);
    }
    let file = match plan.errors {
        true => host::image::rgb_png(sheet.size, &sheet.pixels)?,
        false => {
            let grey: Vec<u8> = sheet.pixels.iter().map(|pixel| pixel[0]).collect();
            host::image::grey_png(sheet.size, &grey)?
        }
    };
    std::fs::write(path, file)?;
    let names: Vec<&str> = plan.tiles.iter().map(|tile| tile.name).collect();
    host::terminal::say(&format!("{path}: {}", names.join(", ")))
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
    let mut shadow = Shadow::new(gpu, &stage.renderer, table::named(name, side)?)?;
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
