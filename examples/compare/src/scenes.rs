//! Several scenes side by side: one table of all techniques.

use std::fmt::Write as _;

use crate::date::date;
use crate::report::{Report, Technique};

/// scenes.md: a row a technique, in the order of the first scene that has it; three columns a scene.
pub fn markdown(reports: &[Report]) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_table(&mut out, reports);
    out
}

fn write_table(out: &mut String, reports: &[Report]) -> std::fmt::Result {
    write!(out, "| |")?;
    for report in reports {
        write!(out, " `{}` ms | wrong | interior |", report.scene_name)?;
    }
    writeln!(out, "\n|---|{}", "--:|".repeat(3 * reports.len()))?;
    let mut rows: Vec<&Technique> = Vec::new();
    for technique in reports.iter().flat_map(|report| &report.techniques) {
        if !rows.iter().any(|row| row.name == technique.name) {
            rows.push(technique);
        }
    }
    for row in rows {
        let still = if row.keeps { ", nothing moving" } else { "" };
        write!(out, "| `{}`{still} |", row.name)?;
        for report in reports {
            let own = report.techniques.iter().find(|own| own.name == row.name);
            write!(out, "{}", own.map_or(" | | |".into(), cells))?;
        }
        writeln!(out)?;
    }
    if let Some(report) = reports.first() {
        let [width, height] = report.size;
        let rounds = report.techniques.first().map(|t| t.generate_ms.samples);
        writeln!(
            out,
            "\n*{}; {width}x{height}, medians of {} rounds, {}.*",
            report.adapter.described(),
            rounds.unwrap_or(0),
            date(report.unix_time),
        )?;
    }
    Ok(())
}

fn cells(technique: &Technique) -> String {
    format!(
        " {:.1} | {:.4} % | {} |",
        technique.total_ms,
        technique.false_lit_percent + technique.false_shadow_percent,
        technique.false_lit_interior + technique.false_shadow_interior,
    )
}
