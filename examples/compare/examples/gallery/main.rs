//! Pictures and loops of the courtyard for the pages:
//!
//! ```text
//! cargo run --release --example gallery -- --day docs/courtyard-day.png      by the sun
//! cargo run --release --example gallery -- --night docs/courtyard-night.png  by sixteen lights
//! cargo run --release --example gallery -- --sun docs/sun.png                the sun goes round: a loop
//! cargo run --release --example gallery -- --pan docs/pan.png                what flips as a camera moves: a loop
//! ```
//!
//! All but the last have four samples a pixel, and shadows by a [`ShadowAtlas`](shadows::ShadowAtlas).

mod pan;
mod scenes;

use std::f32::consts::TAU;

use anyhow::{Result, bail};
use compare::animation::animated_png;
use compare::lamps::Lamps;
use compare::stage::Stage;
use compare::table;
use host::gpu::Gpu;
use host::image::rgb_png;
use host::renderer::Look;
use host::scene::Scene;

const PICTURE: [u32; 2] = [1280, 720];
const LOOP: [u32; 2] = [480, 270];
/// Frames of the sun's round, and how long each is shown.
const FRAMES: u32 = 48;
const MILLISECONDS: u16 = 80;

/// Texels of a cascade or of a face, at most.
const SIDE: u32 = 2048;

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [kind, path] = args.as_slice() else {
        bail!("say --day, --night, --sun or --pan, and the file to write");
    };
    let gpu = Gpu::new(None)?;
    let file = match kind.as_str() {
        "--day" => still(&gpu, scenes::day(scenes::MORNING))?,
        "--night" => still(&gpu, scenes::night())?,
        "--sun" => sun(&gpu)?,
        "--pan" => pan::frames(&gpu)?,
        other => bail!("{other} is none of --day, --night, --sun, --pan"),
    };
    std::fs::write(path, &file)?;
    host::terminal::say(&format!("{path}: {} bytes", file.len()))
}

fn still(gpu: &Gpu, scene: Scene) -> Result<Vec<u8>> {
    rgb_png(PICTURE, &shaded(gpu, scene, PICTURE)?)
}

/// The picture as a player would see it.
fn shaded(gpu: &Gpu, scene: Scene, size: [u32; 2]) -> Result<Vec<[u8; 3]>> {
    let look = Look {
        samples: 4,
        ..Default::default()
    };
    let stage = Stage::with_look(gpu, scene, size, look)?;
    let mut lamps = Lamps::new(gpu, &stage, &table::named("atlas-5x5", SIDE)?)?;
    Ok(lamps.picture(gpu, &stage)?.shaded)
}

fn sun(gpu: &Gpu) -> Result<Vec<u8>> {
    let frames: Vec<_> = (0..FRAMES)
        .map(|frame| {
            let azimuth = scenes::MORNING + TAU * frame as f32 / FRAMES as f32;
            shaded(gpu, scenes::day(azimuth), LOOP)
        })
        .collect::<Result<_>>()?;
    animated_png(LOOP, MILLISECONDS, &frames)
}
