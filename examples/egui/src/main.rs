//! Shadows in an egui application: an eframe window whose picture is drawn in a paint callback, with controls
//! for all settings and the resulting error beside them.
//!
//! `shadow.rs` is everything that such a host adds; `viewport.rs` is where egui calls it.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Parser;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use shadows::glam::Vec3;
use shadows::{Bias, Kernel, Support, wgpu};

mod app;
mod blit;
mod measure;
mod panel;
mod shadow;
mod statistics;
mod viewport;

use panel::Controls;
use shadow::{Settings, Technique};
use viewport::Show;

/// Shadows in an egui window.
#[derive(Parser)]
struct Args {
    /// `spheres`, `courtyard`, `teapot`, or a model file (OBJ, glTF), which is put on a ground.
    #[arg(long, default_value = "spheres")]
    scene: String,
    /// How shadows are found.
    #[arg(long, value_enum, default_value = "map")]
    technique: Technique,
    /// A light infinitely far away.
    #[arg(long)]
    directional: bool,
    /// The map's kernel, as its function in WGSL is called.
    #[arg(long, default_value = "bilinear", value_parser = kernel)]
    kernel: Kernel,
    /// Texels along a side of the map: a power of two, 64 to 4096.
    #[arg(long, default_value_t = 1024, value_parser = size)]
    size: u32,
    /// What the window shows.
    #[arg(long, value_enum, default_value = "picture")]
    show: Show,
    /// Write a picture of the window to this PNG file once the error is known, and close it.
    #[arg(long)]
    screenshot: Option<PathBuf>,
}

fn kernel(wanted: &str) -> Result<Kernel, String> {
    let names: Vec<&str> = Kernel::ALL.map(panel::name).to_vec();
    let place = names.iter().position(|name| *name == wanted);
    place
        .map(|place| Kernel::ALL[place])
        .ok_or_else(|| format!("one of {}", names.join(", ")))
}

fn size(wanted: &str) -> Result<u32, String> {
    match wanted.parse::<u32>() {
        Ok(size) if size.is_power_of_two() && (64..=4096).contains(&size) => Ok(size),
        _ => Err("a power of two, 64 to 4096".into()),
    }
}

fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let scene = host::scene::load(&args.scene, true, None)?;
    if !scene.left_out.is_empty() {
        let left_out = scene.left_out.join(", ");
        host::terminal::note(&format!("{}: left out are {left_out}", args.scene));
    }
    let controls = Controls {
        settings: Settings {
            technique: args.technique,
            directional: args.directional,
            kernel: args.kernel,
            bias: Bias::default(),
            size: args.size,
        },
        light: Vec3::ZERO, // the scene's own
        show: args.show,
        turning: false,
    };
    let options = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default().with_inner_size([1190.0, 700.0]),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: setup(),
            ..Default::default()
        },
        ..Default::default()
    };
    let run = eframe::run_native(
        "shadows",
        options,
        Box::new(|creation| {
            Ok(Box::new(app::App::new(
                creation,
                scene,
                controls,
                args.screenshot,
            )?))
        }),
    );
    run.map_err(|error| anyhow::anyhow!("{error}"))
}

/// egui makes the device; all it needs to know is what is of use to shadows.
fn setup() -> WgpuSetup {
    WgpuSetup::CreateNew(WgpuSetupCreateNew {
        device_descriptor: Arc::new(|adapter| {
            let support = Support::of_adapter(adapter);
            wgpu::DeviceDescriptor {
                label: Some("egui, with shadows"),
                required_features: support.features(),
                required_limits: support.limits(),
                ..Default::default()
            }
        }),
        ..WgpuSetupCreateNew::without_display_handle()
    })
}
