//! What is said of a shader, and all shaders in turn.

use anyhow::{Context as _, Result, ensure};
use serde::Serialize;

use crate::assembly::{self, Counts};
use crate::device::{Device, Stage};
use crate::pipeline::{self, Case};
use crate::{receivers, stages};

/// A shader's cost. Receivers are over a Lambert shader without shadows; all else is whole.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub name: String,
    /// Vector instructions of the path that nearly all pixels take: a loop's times its trips.
    pub valu: i64,
    /// Texture instructions, likewise.
    pub texture: i64,
    /// Loads and stores of buffers by vector address, likewise.
    pub memory: i64,
    pub vgprs: u32,
    /// Waves that a SIMD holds at a time.
    pub waves: u32,
    /// As they lie in the code.
    pub loops: Vec<Loop>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Loop {
    /// How often it is gone round; 0 for what only pixels at an edge of the map go through.
    pub trips: u32,
    pub valu: i64,
    pub texture: i64,
}

/// Compiles everything.
pub fn all(device: &Device) -> Result<Vec<Row>> {
    let base = one(device, &receivers::lambert())?;
    let mut rows = Vec::new();
    for case in receivers::all() {
        let mut row = one(device, &case)?;
        row.valu -= base.valu;
        row.texture -= base.texture;
        row.memory -= base.memory;
        rows.push(row);
    }
    for case in stages::all() {
        rows.push(one(device, &case)?);
    }
    Ok(rows)
}

fn one(device: &Device, case: &Case) -> Result<Row> {
    let compile = || -> Result<Row> {
        let stages = pipeline::compile(device, case)?;
        // Receivers are fragment shaders; casters that write depth have two stages that count.
        let counted: Vec<&Stage> = stages
            .iter()
            .filter(|stage| !case.fragment_only || stage.name.to_lowercase().contains("fragment"))
            .collect();
        ensure!(!counted.is_empty(), "no stage came out");
        row(case, &counted)
    };
    compile().with_context(|| case.name.clone())
}

fn row(case: &Case, stages: &[&Stage]) -> Result<Row> {
    let mut sum = Counts::default();
    let mut loops = Vec::new();
    let (mut vgprs, mut waves) = (0, u32::MAX);
    for stage in stages {
        let (outside, found) = assembly::count(&stage.assembly);
        sum += outside;
        loops.extend(found);
        vgprs = vgprs.max(stage.statistic("VGPRs")?);
        waves = waves.min(stage.statistic("Subgroups per SIMD")?);
    }
    ensure!(
        loops.len() == case.trips.len(),
        "{} loops in the code, {} expected: {loops:?}",
        loops.len(),
        case.trips.len()
    );
    let loops: Vec<Loop> = loops
        .iter()
        .zip(&case.trips)
        .map(|(counts, &trips)| {
            sum += counts.times(trips.into());
            Loop {
                trips,
                valu: counts.valu,
                texture: counts.texture,
            }
        })
        .collect();
    Ok(Row {
        name: case.name.clone(),
        valu: sum.valu,
        texture: sum.texture,
        memory: sum.memory,
        vgprs,
        waves,
        loops,
    })
}

/// An array, a row a line, so that a difference is read in lines.
pub fn to_json(rows: &[Row]) -> String {
    let lines: Vec<String> = rows
        .iter()
        .filter_map(|row| serde_json::to_string(row).ok())
        .collect();
    format!("[\n{}\n]\n", lines.join(",\n"))
}
