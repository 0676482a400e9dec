//! The table of hard cases, for people and for machines.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::outcome::Outcome;
use super::seams::FACTOR;
use super::{ATLAS_NAMES, CHEAP_NAMES, causes};

/// Pictures side by side on the sheet.
const COLUMNS: usize = 6;

/// A table of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Usual,
    Atlas,
    Cheap,
}

impl Part {
    fn has(self, technique: &str) -> bool {
        match self {
            Self::Usual => ![ATLAS_NAMES.as_slice(), &CHEAP_NAMES]
                .concat()
                .contains(&technique),
            Self::Atlas => technique == "atlas-2x2" || ATLAS_NAMES.contains(&technique),
            Self::Cheap => CHEAP_NAMES.contains(&technique),
        }
    }
}

/// A case and what each technique made of it.
pub struct Row {
    pub name: &'static str,
    pub build: &'static str,
    pub answer: &'static str,
    /// As many as there are techniques; `None` where it does not apply.
    pub outcomes: Vec<Option<Outcome>>,
    /// The first of its situations, shaded.
    pub picture: Vec<[u8; 3]>,
    /// Whether it is what an atlas goes through.
    pub of_atlas: bool,
}

/// Everything that was tried.
pub struct Table {
    pub driver: String,
    pub date: String,
    pub command: String,
    pub size: [u32; 2],
    pub rounds: u32,
    pub techniques: Vec<String>,
    /// In which way `volume` finds silhouettes on this driver.
    pub way: String,
    pub rows: Vec<Row>,
    /// Bad input: what, and what happened.
    pub refusals: Vec<Refusal>,
}

/// Input that must be refused, or a degenerate size that must work.
pub struct Refusal {
    pub what: String,
    /// What it said or did; `Err` if that was wrong.
    pub outcome: Result<String, String>,
}

impl Table {
    /// What should have passed and did not, a line each.
    pub fn failures(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for row in &self.rows {
            for (technique, outcome) in self.techniques.iter().zip(&row.outcomes) {
                let failures = outcome.iter().flat_map(|outcome| &outcome.failures);
                lines.extend(failures.map(|what| format!("{technique}: {}: {what}", row.name)));
            }
        }
        lines.extend(self.refusals.iter().filter_map(|refusal| {
            let failure = refusal.outcome.as_ref().err()?;
            Some(format!("{}: {failure}", refusal.what))
        }));
        lines
    }

    /// For people.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        let [width, height] = self.size;
        let _ = writeln!(
            text,
            "# Hard cases\n\n\
             Written by `{}` on {}, {}.\n\n\
             Each case was tried in {} rounds of random lights and cameras (fixed seeds), at \
             {width}x{height} pixels, against exact ray casting in f64. A pixel is *interior* if \
             resolution cannot explain an error: if it is a pixel (volumes), or 1.5 texels plus the kernel's \
             radius (maps), away from any edge of the true shadow.\n\n\
             `0` means: no interior pixel is wrong in any round; `0 (edges)`: only edges have more \
             errors than elsewhere. A figure is a **known limit**: the wrong interior pixels in per cent of those \
             that face the light. Its cause and its bound are given below the table; above the bound, the case \
             fails. **FAILS** is a defect. `-`: does not apply.\n\n\
             On this driver `volume` found its silhouettes in the way `Silhouettes::{}`, as did the \
             other volume techniques that do not specify a way: `Auto` chooses `Compute` on a GPU, which \
             `volume-compute` uses here, and `Cpu` on a software adapter.\n",
            self.command, self.date, self.driver, self.rounds, self.way
        );
        self.results(&mut text, Part::Usual);
        self.atlas(&mut text);
        self.cheap(&mut text);
        self.limits(&mut text);
        self.seams(&mut text);
        self.inputs(&mut text);
        self.descriptions(&mut text);
        text
    }

    /// A part's techniques on its cases.
    fn results(&self, text: &mut String, part: Part) {
        let is_shown = |at: &usize| part.has(&self.techniques[*at]);
        let shown: Vec<usize> = (0..self.techniques.len()).filter(is_shown).collect();
        let names: Vec<&str> = shown.iter().map(|&at| &*self.techniques[at]).collect();
        let _ = writeln!(text, "| Case | {} |", names.join(" | "));
        let _ = writeln!(text, "|---{}|", "|---".repeat(shown.len()));
        for row in &self.rows {
            let tried = shown.iter().any(|&at| row.outcomes[at].is_some());
            if row.of_atlas != (part == Part::Atlas) || (part == Part::Cheap && !tried) {
                continue;
            }
            let cells: Vec<String> = shown.iter().map(|&at| cell(&row.outcomes[at])).collect();
            let _ = writeln!(text, "| {} | {} |", row.name, cells.join(" | "));
        }
        text.push('\n');
    }

    fn cheap(&self, text: &mut String) {
        text.push_str(
            "## Cheap and baked techniques\n\n\
             The same, on the cases that show where each of these breaks. `planar` and `planar-soft` \
             need a plane that receives, `baked` one sample per pixel. `-`: not tried. The truth is that of a \
             light without a size; of soft edges, the darker half counts as shadow.\n\n",
        );
        self.results(text, Part::Cheap);
    }

    fn atlas(&self, text: &mut String) {
        text.push_str(
            "## Atlas and cascades\n\n\
             What only an atlas can get wrong, which keeps from frame to frame what did not change: many lights at once, several \
             frames and views, each light's picture against its own truth. Of cascades, interior is judged by \
             the texels of the one that a pixel reads, not by the widest.\n\n",
        );
        self.results(text, Part::Atlas);
    }

    fn limits(&self, text: &mut String) {
        text.push_str("## Known limits\n\n");
        text.push_str(&causes::markdown(&self.techniques, &self.rows));
        let failures = self.failures();
        for failure in &failures {
            let _ = writeln!(text, "- **FAILS**: {failure}.");
        }
        if !failures.is_empty() {
            text.push('\n');
        }
    }

    fn seams(&self, text: &mut String) {
        let _ = write!(
            text,
            "## Cube seams against face centres\n\n\
             Wrong pixels at the edges of shadows near seams and corners, by how much of them the \
             width of a texel there explains, over the same at face centres; above {FACTOR} fails.\n\n\
             | Technique | Seams over centres |\n|---|---|\n"
        );
        for row in &self.rows {
            for (technique, outcome) in self.techniques.iter().zip(&row.outcomes) {
                if let Some(rates) = outcome.as_ref().and_then(|outcome| outcome.rates) {
                    let _ = writeln!(text, "| {technique} | {:.2} |", rates.ratio());
                }
            }
        }
        text.push('\n');
    }

    fn inputs(&self, text: &mut String) {
        text.push_str("## Bad input and degenerate sizes\n\n| What | What happened |\n|---|---|\n");
        for refusal in &self.refusals {
            let said = match &refusal.outcome {
                Ok(said) => said.clone(),
                Err(failure) => format!("**FAILS**: {failure}"),
            };
            let _ = writeln!(text, "| {} | {} |", refusal.what, said.replace('|', "\\|"));
        }
        text.push('\n');
    }

    fn descriptions(&self, text: &mut String) {
        let _ = writeln!(
            text,
            "## What the cases are\n\n![Each case's first scene, {COLUMNS} in a row](hard-cases.png)\n\n\
             | Picture | Case | Build | Right answer |\n|---|---|---|---|"
        );
        for (place, row) in self.rows.iter().enumerate() {
            let (line, column) = (place / COLUMNS + 1, place % COLUMNS + 1);
            let Row {
                name,
                build,
                answer,
                ..
            } = row;
            let _ = writeln!(text, "| {line}.{column} | {name} | {build} | {answer} |");
        }
    }

    /// Every case's first situation at half the size, as in the table from the top left, and the
    /// size of all.
    pub fn sheet(&self) -> ([u32; 2], Vec<[u8; 3]>) {
        let [width, height] = self.size.map(|side| (side / 2) as usize);
        let size = [width * COLUMNS, height * self.rows.len().div_ceil(COLUMNS)];
        let mut sheet = vec![[255; 3]; size[0] * size[1]];
        for (place, row) in self.rows.iter().enumerate() {
            let (left, top) = (place % COLUMNS * width, place / COLUMNS * height);
            // A pixel stays white between the pictures.
            for (y, x) in (1..height).flat_map(|y| (1..width).map(move |x| (y, x))) {
                let from = 2 * y * self.size[0] as usize + 2 * x;
                if let Some(&pixel) = row.picture.get(from) {
                    sheet[(top + y) * size[0] + left + x] = pixel;
                }
            }
        }
        (size.map(|side| side as u32), sheet)
    }

    /// For machines.
    pub fn json(&self) -> Value {
        let outcome = |outcome: &Outcome| {
            json!({
                "situations": outcome.situations,
                "pixels": outcome.counted,
                "wrong": outcome.wrong,
                "false_lit": outcome.false_lit,
                "false_shadow": outcome.false_shadow,
                "worst_round": outcome.worst,
                "seams_against_middle": outcome.rates.map(|rates| rates.ratio()),
                "limits": outcome.limits,
                "failures": outcome.failures,
            })
        };
        let row = |row: &Row| {
            let outcomes = self.techniques.iter().zip(&row.outcomes);
            let by_technique: serde_json::Map<String, Value> = outcomes
                .filter_map(|(name, found)| Some((name.clone(), outcome(found.as_ref()?))))
                .collect();
            json!({ "case": row.name, "techniques": by_technique })
        };
        let refusal = |refusal: &Refusal| {
            let (right, said) = match &refusal.outcome {
                Ok(said) => (true, said),
                Err(said) => (false, said),
            };
            json!({ "what": refusal.what, "right": right, "said": said })
        };
        json!({
            "driver": self.driver,
            "date": self.date,
            "size": self.size,
            "rounds": self.rounds,
            "cases": self.rows.iter().map(row).collect::<Vec<_>>(),
            "inputs": self.refusals.iter().map(refusal).collect::<Vec<_>>(),
        })
    }
}

fn cell(outcome: &Option<Outcome>) -> String {
    match outcome {
        None => "-".into(),
        Some(outcome) if !outcome.failures.is_empty() => "**FAILS**".into(),
        Some(outcome) if outcome.limits.is_empty() => "0".into(),
        Some(outcome) if outcome.interior() == 0 => "0 (edges)".into(),
        Some(outcome) => format!("{:.4} %", outcome.interior_percent()),
    }
}
