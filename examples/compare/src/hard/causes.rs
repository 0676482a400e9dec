//! Known limits by their cause: what is wrong for one reason stands together.

use std::fmt::Write as _;

use super::limits;
use super::outcome::Outcome;
use super::table::Row;

/// Techniques that came to the same on one case.
struct Line<'a> {
    case: &'static str,
    techniques: Vec<&'a str>,
    outcome: &'a Outcome,
    /// See [`limits::Limit::at_most`].
    at_most: Option<[f64; 3]>,
}

/// One cause, and what it does.
struct Cause<'a> {
    why: &'static str,
    lines: Vec<Line<'a>>,
}

impl Cause<'_> {
    /// Of what is there for comparison only.
    fn is_textbook(&self) -> bool {
        let mut techniques = self.lines.iter().flat_map(|line| &line.techniques);
        techniques.all(|technique| technique.ends_with("-textbook"))
    }
}

/// All causes, those of this crate's own techniques first.
fn causes<'a>(techniques: &'a [String], rows: &'a [Row]) -> Vec<Cause<'a>> {
    let mut causes: Vec<Cause<'a>> = Vec::new();
    for row in rows {
        for (technique, outcome) in techniques.iter().zip(&row.outcomes) {
            let Some(outcome) = outcome else { continue };
            for &why in &outcome.limits {
                let place = causes.iter().position(|cause| cause.why == why);
                let place = place.unwrap_or_else(|| {
                    causes.push(Cause {
                        why,
                        lines: Vec::new(),
                    });
                    causes.len() - 1
                });
                add(&mut causes[place].lines, row.name, technique, outcome);
            }
        }
    }
    causes.sort_by_key(Cause::is_textbook);
    causes
}

fn add<'a>(
    lines: &mut Vec<Line<'a>>,
    case: &'static str,
    technique: &'a str,
    outcome: &'a Outcome,
) {
    let at_most = limits::of(case, technique).map(|limit| limit.at_most);
    let same = lines.iter_mut().find(|line| {
        let counts = |o: &Outcome| (o.interior(), o.counted, o.wrong);
        line.case == case && line.at_most == at_most && counts(line.outcome) == counts(outcome)
    });
    match same {
        Some(line) => line.techniques.push(technique),
        None => lines.push(Line {
            case,
            techniques: vec![technique],
            outcome,
            at_most,
        }),
    }
}

/// A paragraph and a table for each cause.
pub fn markdown(techniques: &[String], rows: &[Row]) -> String {
    let mut text = "Grouped by cause. Counts are wrong interior pixels of all rounds, of the pixels that face the \
                    light. The bound is for a single round, in per cent of these pixels: interior pixels falsely \
                    lit / interior pixels falsely in shadow / all wrong pixels, edges included.\n\n"
        .to_owned();
    for cause in causes(techniques, rows) {
        let _ = writeln!(
            text,
            "**{}.**\n\n\
             | Case | Techniques | Wrong interior pixels | Wrong with edges | Bound |\n\
             |---|---|--:|--:|--:|",
            capitalised(cause.why)
        );
        for line in &cause.lines {
            let _ = writeln!(
                text,
                "| {} | {} | {} of {} | {:.3} % | {} |",
                line.case,
                line.techniques.join(", "),
                line.outcome.interior(),
                line.outcome.counted,
                line.outcome.wrong_percent(),
                line.at_most.map_or("-".into(), |[lit, shadow, all]| {
                    format!("{lit} / {shadow} / {all}")
                })
            );
        }
        text.push('\n');
    }
    text
}

fn capitalised(why: &str) -> String {
    let mut letters = why.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
