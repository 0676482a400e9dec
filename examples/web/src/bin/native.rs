//! What the page draws, drawn without a browser, for the test to compare with:
//! `native ADAPTER FOLDER WIDTHxHEIGHT MEASURED [NAME=VALUE ...]` with the names of the page's address.
//!
//! Writes both halves (`left.rgba`, `right.rgba`), those of the smaller picture by which the error is
//! measured, of `MEASURED` pixels (`left.visibility`, `right.visibility`), its counts (`counts.json`), what
//! the reference is told (`job.bin`, f32), and the scene in short (`scene.txt`).

use std::env;
use std::fs;
use std::path::PathBuf;

use anyhow::{Context as _, Result};
use host::gpu::Gpu;
use shadows::wgpu::TextureAspect;
use shadows_web::app::App;
use shadows_web::choice::Choice;
use shadows_web::digest::digest;
use shadows_web::job::{Count, Job, Judge};

const SIDES: [&str; 2] = ["left", "right"];

fn main() -> Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [adapter, folder, size, measured, choices @ ..] = &arguments[..] else {
        anyhow::bail!("native ADAPTER FOLDER WIDTHxHEIGHT MEASURED [NAME=VALUE ...]");
    };
    let (folder, size, measured) = (PathBuf::from(folder), pixels(size)?, pixels(measured)?);
    let mut choice = Choice::default();
    for pair in choices {
        let (name, value) = pair.split_once('=').context("NAME=VALUE is wanted")?;
        choice.set(name, value)?;
    }
    fs::create_dir_all(&folder)?;

    let mut app = App::new(Gpu::new(Some(adapter))?, choice, size)?;
    let mut encoder = app.gpu.device.create_command_encoder(&Default::default());
    app.encode([true; 2], &mut encoder)?;
    app.gpu.queue.submit([encoder.finish()]);
    for (name, side) in SIDES.iter().zip(app.picture().sides()) {
        let texture = side.renderer.shaded();
        let bytes = app.gpu.read_texture(texture, 0, TextureAspect::All);
        fs::write(folder.join(format!("{name}.rgba")), bytes)?;
    }

    let mut encoder = app.gpu.device.create_command_encoder(&Default::default());
    let (textures, job) = app.encode_measured(measured, &mut encoder)?;
    app.gpu.queue.submit([encoder.finish()]);
    let read = |texture| app.gpu.read_texture(texture, 0, TextureAspect::All);
    let visibility = textures.each_ref().map(read);
    for (name, bytes) in SIDES.iter().zip(&visibility) {
        fs::write(folder.join(format!("{name}.visibility")), bytes)?;
    }
    fs::write(
        folder.join("scene.txt"),
        digest(&app.world.scene).join("\n"),
    )?;
    // As a worker gets it.
    let numbers = job.to_numbers();
    fs::write(folder.join("job.bin"), bytemuck::cast_slice(&numbers[..]))?;
    let job = Job::from_numbers(&numbers);
    let mut counts = [Count::default(); 2];
    let rows = [0, measured[1]];
    let bytes = visibility.each_ref().map(|bytes| &bytes[..]);
    Judge::new(choice.place, choice.light)?.rows(&job, measured, rows, bytes, &mut counts)?;
    let counts = counts.map(|count| {
        let Count {
            counted,
            false_lit,
            false_shadow,
            interior,
        } = count;
        format!("[{counted}, {false_lit}, {false_shadow}, {interior}]")
    });
    fs::write(
        folder.join("counts.json"),
        format!("[{}]\n", counts.join(", ")),
    )?;
    println!("{}", host::gpu::describe(&app.gpu.info));
    Ok(())
}

fn pixels(text: &str) -> Result<[u32; 2]> {
    let (width, height) = text.split_once('x').context("WIDTHxHEIGHT is wanted")?;
    Ok([width.parse()?, height.parse()?])
}
