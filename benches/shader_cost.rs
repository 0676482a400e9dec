//! What this crate's shaders cost on a GPU's instruction set, without a GPU: Mesa's RADV compiles
//! them on its null device and says what came out. The counts are exact and the same in every run; they
//! do not say what textures, caches and divergence cost.
//!
//! ```text
//! cargo bench --bench shader_cost                       # a table
//! cargo bench --bench shader_cost -- --out FILE         # JSON: name, valu, texture, memory, vgprs, waves, loops
//! cargo bench --bench shader_cost -- --page FILE        # docs/shader-cost.md
//! cargo bench --bench shader_cost -- --check            # fails if anything costs more than it did
//! cargo bench --bench shader_cost -- --keep             # what `--check` compares with, from now on
//! ```
//!
//! What is kept belongs to a version of Mesa: `shader_cost/kept/`. Without RADV, or without a file for its
//! version, nothing is compared, and that is said.

#[path = "shader_cost/assembly.rs"]
mod assembly;
#[path = "shader_cost/device.rs"]
mod device;
#[path = "shader_cost/kept.rs"]
mod kept;
#[path = "../tests/common/modules.rs"]
mod modules;
#[path = "shader_cost/page.rs"]
mod page;
#[path = "../tests/common/pcf.rs"]
mod pcf;
#[path = "shader_cost/pipeline.rs"]
mod pipeline;
#[path = "shader_cost/receivers.rs"]
mod receivers;
#[path = "shader_cost/row.rs"]
mod row;
#[path = "shader_cost/stages.rs"]
mod stages;

use std::process::{Command, ExitCode};

use anyhow::{Context as _, Result};

use crate::device::Device;
use crate::row::Row;

/// RDNA2: the instruction set of two consoles and the usual mid-range desktop GPU.
const FAMILY: &str = "navi21";

const ICD: &str = "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    // RADV reads its environment when it is loaded, so it is set for a process of its own.
    if std::env::var_os("RADV_FORCE_FAMILY").is_none() {
        if !std::path::Path::new(ICD).exists() {
            println!("skipped: no RADV here ({ICD}); Debian and Ubuntu: mesa-vulkan-drivers");
            return ExitCode::SUCCESS;
        }
        let status = std::env::current_exe().and_then(|own| {
            Command::new(own)
                .args(&arguments)
                .env("RADV_FORCE_FAMILY", FAMILY)
                .env("VK_DRIVER_FILES", ICD)
                .env("VK_ICD_FILENAMES", ICD)
                .env("MESA_SHADER_CACHE_DISABLE", "true")
                // Its own culling of triangles, which it puts into vertex shaders, is not ours to count.
                .env("RADV_DEBUG", "nonggc")
                .status()
        });
        return match status {
            Ok(status) if status.success() => ExitCode::SUCCESS,
            _ => ExitCode::FAILURE,
        };
    }
    match run(&arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &[String]) -> Result<ExitCode> {
    let after = |option: &str| {
        let place = arguments.iter().position(|argument| argument == option)?;
        arguments.get(place + 1)
    };
    let device = match Device::new() {
        Ok(device) => device,
        Err(error) => {
            println!("skipped: RADV gives no null device: {error:#}");
            return Ok(ExitCode::SUCCESS);
        }
    };
    let rows = row::all(&device)?;
    if let Some(file) = after("--out") {
        std::fs::write(file, row::to_json(&rows)).with_context(|| file.clone())?;
    } else if let Some(file) = after("--page") {
        std::fs::write(file, page::page(&rows, &device)).with_context(|| file.clone())?;
    } else if arguments.iter().any(|argument| argument == "--keep") {
        println!("{}", kept::keep(&rows, &device)?);
    } else if arguments.iter().any(|argument| argument == "--check") {
        return kept::check(&rows, &device);
    } else {
        print_table(&rows, &device);
    }
    Ok(ExitCode::SUCCESS)
}

fn print_table(rows: &[Row], device: &Device) {
    println!("{} / {}", device.name, device.driver);
    println!("{:40} valu texture memory vgprs waves loops", "");
    for row in rows {
        println!(
            "{:40} {:4} {:7} {:6} {:5} {:5} {}",
            row.name,
            row.valu,
            row.texture,
            row.memory,
            row.vgprs,
            row.waves,
            row.loops
                .iter()
                .map(|l| format!("{}x({} valu {} tex)", l.trips, l.valu, l.texture))
                .collect::<Vec<_>>()
                .join(" ")
        );
    }
}
