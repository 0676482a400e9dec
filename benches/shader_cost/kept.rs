//! What shaders cost when that was last accepted: one file for each version of Mesa.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context as _, Result};
use serde_json::Value;

use crate::device::Device;
use crate::row::{self, Row};

fn file(device: &Device) -> PathBuf {
    let version = device.mesa_version().unwrap_or("unknown");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/shader_cost/kept");
    PathBuf::from(folder).join(format!("mesa-{version}-{}.json", crate::FAMILY))
}

/// Writes the file that later runs compare with.
pub fn keep(rows: &[Row], device: &Device) -> Result<String> {
    let file = file(device);
    std::fs::write(&file, row::to_json(rows)).with_context(|| file.display().to_string())?;
    Ok(format!("kept: {}", file.display()))
}

/// Fails if anything costs more than what is kept, or is not kept at all.
pub fn check(rows: &[Row], device: &Device) -> Result<ExitCode> {
    let file = file(device);
    let Ok(text) = std::fs::read_to_string(&file) else {
        println!("skipped: nothing is kept for {}", device.driver);
        return Ok(ExitCode::SUCCESS);
    };
    let kept: Vec<Value> =
        serde_json::from_str(&text).with_context(|| file.display().to_string())?;
    let kept: BTreeMap<&str, &Value> = kept
        .iter()
        .filter_map(|row| Some((row["name"].as_str()?, row)))
        .collect();
    let mut worse = 0;
    for row in rows {
        let Some(old) = kept.get(&row.name[..]) else {
            println!("{}: is not kept yet", row.name);
            worse += 1;
            continue;
        };
        for (what, before, now) in costs(row, old) {
            if now > before {
                worse += 1;
                println!("{}: {what} {before} -> {now}: costs more", row.name);
            } else if now < before {
                println!(
                    "{}: {what} {before} -> {now}: costs less; keep it",
                    row.name
                );
            }
        }
    }
    if worse == 0 {
        println!(
            "{} shaders cost no more than in {}",
            rows.len(),
            file.display()
        );
        return Ok(ExitCode::SUCCESS);
    }
    println!(
        "{worse} costs rose. If that is worth it: cargo bench --bench shader_cost -- --keep, and the reason in the commit"
    );
    Ok(ExitCode::FAILURE)
}

/// What may not rise; occupancy counts as the waves that are lost.
fn costs<'a>(row: &'a Row, old: &'a Value) -> impl Iterator<Item = (&'static str, i64, i64)> {
    let before = |name: &str| old[name].as_i64().unwrap_or(0);
    let loops = old["loops"].as_array().map_or(0, Vec::len);
    [
        ("valu", before("valu"), row.valu),
        ("texture", before("texture"), row.texture),
        ("memory", before("memory"), row.memory),
        ("vgprs", before("vgprs"), row.vgprs.into()),
        ("waves lost", -before("waves"), -i64::from(row.waves)),
        ("loops", loops as i64, row.loops.len() as i64),
    ]
    .into_iter()
}
