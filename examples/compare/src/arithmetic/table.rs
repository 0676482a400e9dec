//! The table of variants, for people and for machines.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::trial::{Kinds, Row, Wrong};

/// Everything that was drawn.
pub struct Table {
    pub driver: String,
    pub date: String,
    pub command: String,
    pub size: [u32; 2],
    pub rounds: u32,
    pub scenes: Vec<String>,
    pub rows: Vec<Row>,
}

impl Table {
    /// What should have passed and did not, a line each.
    pub fn failures(&self) -> Vec<String> {
        let lines = self.rows.iter().flat_map(|row| {
            let name = row.variant.name;
            row.failures
                .iter()
                .map(move |what| format!("{name}: {what}"))
        });
        lines.collect()
    }

    /// For people.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        let [width, height] = self.size;
        let _ = writeln!(
            text,
            "# Arithmetic that drivers may choose\n\nWritten by `{}` on {}, {}.\n\n\
             Scenes at {width}x{height} pixels, hard cases in {} rounds, maps and volumes: wrong pixels \
             in per cent of those that face the light, and (behind the stroke) how many of them are \
             interior, the worst of the kind's techniques.\n",
            self.command, self.date, self.driver, self.rounds
        );
        self.variants(&mut text);
        self.grown(&mut text);
        text
    }

    fn variants(&self, text: &mut String) {
        let mut heads: Vec<String> = Vec::new();
        for scene in &self.scenes {
            heads.extend([format!("{scene}, maps"), format!("{scene}, volumes")]);
        }
        let _ = writeln!(
            text,
            "| Variant | {} | hard cases that fail |\n|---{}|---|",
            heads.join(" | "),
            "|---".repeat(heads.len())
        );
        for row in &self.rows {
            let cells: Vec<String> = row.scenes.iter().flatten().map(cell).collect();
            let failed = row.failures.len();
            let _ = writeln!(
                text,
                "| `{}` | {} | {failed} |",
                row.variant.name,
                cells.join(" | ")
            );
        }
        text.push('\n');
        for row in &self.rows {
            let _ = writeln!(text, "- `{}`: {}.", row.variant.name, row.variant.what);
        }
        text.push('\n');
    }

    /// The hard cases that some variant makes more wrong than the first.
    fn grown(&self, text: &mut String) {
        let Some((plain, others)) = self.rows.split_first() else {
            return;
        };
        let names: Vec<&str> = self.rows.iter().map(|row| row.variant.name).collect();
        let _ = writeln!(
            text,
            "Hard cases that some variant makes more wrong than `{}`:\n\n\
             | Case | | {} |\n|---|---{}|",
            plain.variant.name,
            names.join(" | "),
            "|---".repeat(names.len())
        );
        for (place, (case, _)) in plain.cases.iter().enumerate() {
            for (kind, name) in ["maps", "volumes"].into_iter().enumerate() {
                let of = |row: &Row| row.cases[place].1[kind];
                let before = of(plain);
                let worse = |row: &Row| is_worse(of(row), before);
                if others.iter().any(worse) {
                    let cells: Vec<String> = self.rows.iter().map(|row| cell(&of(row))).collect();
                    let _ = writeln!(text, "| {case} | {name} | {} |", cells.join(" | "));
                }
            }
        }
        text.push('\n');
        for failure in self.failures() {
            let _ = writeln!(text, "- **FAILS**: {failure}.");
        }
    }

    /// For machines.
    pub fn json(&self) -> Value {
        let kinds = |kinds: &Kinds| {
            let [maps, volumes] = kinds
                .map(|wrong| json!({ "wrong_percent": wrong.percent, "interior": wrong.interior }));
            json!({ "maps": maps, "volumes": volumes })
        };
        let row = |row: &Row| {
            let scenes = self.scenes.iter().zip(&row.scenes);
            let scenes = scenes.map(|(name, found)| (name.clone(), kinds(found)));
            let cases = row.cases.iter();
            let cases = cases.map(|(name, found)| ((*name).to_owned(), kinds(found)));
            json!({
                "variant": row.variant.name,
                "scenes": scenes.collect::<serde_json::Map<_, _>>(),
                "hard_cases": cases.collect::<serde_json::Map<_, _>>(),
                "failures": row.failures,
            })
        };
        json!({
            "driver": self.driver,
            "date": self.date,
            "command": self.command,
            "size": self.size,
            "rounds": self.rounds,
            "variants": self.rows.iter().map(row).collect::<Vec<_>>(),
        })
    }
}

/// By more than the wrong pixels vary anyway, or in the interior.
fn is_worse(now: Wrong, before: Wrong) -> bool {
    now.interior > before.interior || now.percent > 1.05 * before.percent + 0.002
}

fn cell(wrong: &Wrong) -> String {
    match wrong.percent {
        0.0 => "0".into(),
        percent => format!("{percent:.4} / {}", wrong.interior),
    }
}
