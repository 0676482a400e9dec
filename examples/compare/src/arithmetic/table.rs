//! The table of variants, for people and for machines.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::trial::{Found, Row};

/// Everything that was drawn. The first row is of the variant that changes nothing.
pub struct Table {
    pub driver: String,
    pub date: String,
    pub command: String,
    pub size: [u32; 2],
    pub rounds: u32,
    pub rows: Vec<Row>,
}

/// A picture of a variant and the same as it is written.
type Pair<'a> = (&'a Found, &'a Found);

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
             Scenes at {width}x{height} pixels, hard cases in {} rounds. By how much more is wrong than \
             without other arithmetic, at most: in points of a per cent of the pixels that face the light, \
             and in interior pixels, and where that is.\n",
            self.command, self.date, self.driver, self.rounds
        );
        self.greatest(&mut text);
        self.risen(&mut text);
        for failure in self.failures() {
            let _ = writeln!(text, "- **FAILS**: {failure}.");
        }
        text
    }

    /// A row of each variant, beside what it came to as written.
    fn against_plain<'a>(&'a self, row: &'a Row) -> Vec<Pair<'a>> {
        let plain = self.rows.first().map(|plain| plain.found.as_slice());
        row.found.iter().zip(plain.unwrap_or_default()).collect()
    }

    fn greatest(&self, text: &mut String) {
        text.push_str(
            "| Variant | maps, wrong | maps, interior | volumes, wrong | volumes, interior | fail |\n\
             |---|---|---|---|---|--:|\n",
        );
        for row in self.rows.iter().skip(1) {
            let _ = write!(text, "| `{}` |", row.variant.name);
            for is_volume in [false, true] {
                let mut pairs = self.against_plain(row);
                pairs.retain(|(now, _)| now.is_volume == is_volume);
                let _ = write!(
                    text,
                    " {} | {} |",
                    most_wrong(&pairs),
                    most_interior(&pairs)
                );
            }
            let _ = writeln!(text, " {} |", row.failures.len());
        }
        text.push('\n');
    }

    /// What some variant gives more interior pixels.
    fn risen(&self, text: &mut String) {
        text.push_str(
            "More interior pixels than as written:\n\n\
             | Case or scene | Technique | Variant | as written | now | wrong, as written | now |\n\
             |---|---|---|--:|--:|--:|--:|\n",
        );
        for row in self.rows.iter().skip(1) {
            for (now, before) in self.against_plain(row) {
                if now.wrong.interior > before.wrong.interior {
                    let _ = writeln!(
                        text,
                        "| {} | `{}` | `{}` | {} | {} | {:.4} % | {:.4} % |",
                        now.what,
                        now.technique,
                        row.variant.name,
                        before.wrong.interior,
                        now.wrong.interior,
                        before.wrong.percent,
                        now.wrong.percent,
                    );
                }
            }
        }
        text.push('\n');
    }

    /// For machines.
    pub fn json(&self) -> Value {
        let found = |found: &Found| {
            json!({
                "what": found.what,
                "technique": found.technique,
                "wrong_percent": found.wrong.percent,
                "interior": found.wrong.interior,
            })
        };
        let row = |row: &Row| {
            json!({
                "variant": row.variant.name,
                "found": row.found.iter().map(found).collect::<Vec<_>>(),
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

fn most_wrong(pairs: &[Pair<'_>]) -> String {
    let rise = |(now, before): &Pair<'_>| now.wrong.percent - before.wrong.percent;
    let most = pairs.iter().max_by(|a, b| rise(a).total_cmp(&rise(b)));
    match most.filter(|pair| rise(pair) > 0.0) {
        Some(pair) => format!(
            "{:.4} ({}, `{}`)",
            rise(pair),
            pair.0.what,
            pair.0.technique
        ),
        None => "0".into(),
    }
}

fn most_interior(pairs: &[Pair<'_>]) -> String {
    let rise = |(now, before): &Pair<'_>| now.wrong.interior.saturating_sub(before.wrong.interior);
    let most = pairs.iter().max_by_key(|pair| rise(pair));
    match most.filter(|pair| rise(pair) > 0) {
        Some(pair) => format!("{} ({}, `{}`)", rise(pair), pair.0.what, pair.0.technique),
        None => "0".into(),
    }
}
