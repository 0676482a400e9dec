//! What came out, against what is expected.

use anyhow::Result;
use shadows::reference::{Class, Comparison, Interior, ReferenceImage, Verdict as PixelVerdict};

use super::cases::Expect;

/// The part of the pixels that may be wrong where [`Expect::Rare`] is said.
const RARE: f64 = 4e-6;

/// How a technique did on one situation, or on all of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Pixels whose surface faces the light.
    pub counted: usize,
    /// Wrong pixels, edges included.
    pub wrong: usize,
    /// Wrong pixels where resolution is no excuse, and pixels lit where nothing was drawn.
    pub interior: usize,
    /// In how many situations.
    pub situations: usize,
    /// Of how many of these something is to be said.
    pub limits: Vec<&'static str>,
    /// What failed, by situation.
    pub failures: Vec<String>,
}

/// What one technique's frame gave.
pub struct Frame<'a> {
    pub visibility: &'a [u8],
    pub interior: Interior,
    /// Whether the renderer says that its 8-bit counts may be wrong.
    pub may_wrap: bool,
}

/// Compares a picture with the reference.
///
/// # Errors
/// If the picture does not fit the reference.
pub fn judge(
    what: &str,
    reference: &ReferenceImage,
    frame: &Frame<'_>,
    expect: Expect,
) -> Result<Outcome> {
    let found = reference.compare(frame.visibility, frame.interior)?;
    let background = drawn_on_nothing(reference, frame.visibility);
    let interior = found.false_lit_interior + found.false_shadow_interior + background;
    let mut outcome = Outcome {
        counted: found.lit_facing,
        wrong: found.false_lit + found.false_shadow + background,
        interior,
        situations: 1,
        ..Outcome::default()
    };
    if let Expect::Reported(why) = expect {
        // Loss that no interior pixel sees is to be said, too.
        outcome.limits.extend((outcome.wrong > 0).then_some(why));
        return Ok(outcome);
    }
    let excuse = match expect {
        _ if interior == 0 => return Ok(outcome),
        Expect::Rare(why) => Some(why),
        Expect::Streaks(why) if !has_blocks(&found, reference.width() as usize) => Some(why),
        Expect::Wraps if frame.may_wrap => Some("8-bit counts wrap at 256; the renderer says so"),
        _ => None,
    };
    match excuse {
        Some(why) => outcome.limits.push(why),
        None => outcome
            .failures
            .push(format!("{what}: {interior} interior pixels are wrong")),
    }
    Ok(outcome)
}

/// Pixels that something was drawn at where the reference sees nothing, nor beside it: edges are
/// rounded to parts of a pixel.
fn drawn_on_nothing(reference: &ReferenceImage, visibility: &[u8]) -> usize {
    let (width, height) = (reference.width() as usize, reference.height() as usize);
    let nothing: Vec<bool> = reference
        .classes()
        .map(|class| class == Class::Background)
        .collect();
    let around = |place: usize, end: usize| place.saturating_sub(1)..(place + 2).min(end);
    let alone = |pixel: usize| {
        let mut rows = around(pixel / width, height);
        rows.all(|row| around(pixel % width, width).all(|column| nothing[row * width + column]))
    };
    (0..nothing.len())
        .filter(|&pixel| visibility[pixel] != 0 && alone(pixel))
        .count()
}

/// Whether four wrong interior pixels form a square: a streak is thinner.
fn has_blocks(found: &Comparison, width: usize) -> bool {
    let wrong = |pixel: usize| {
        matches!(
            found.verdicts.get(pixel),
            Some(PixelVerdict::FalseLitInterior | PixelVerdict::FalseShadowInterior)
        )
    };
    (0..found.verdicts.len())
        .filter(|pixel| pixel % width + 1 < width)
        .any(|pixel| {
            [0, 1, width, width + 1]
                .iter()
                .all(|step| wrong(pixel + step))
        })
}

impl Outcome {
    /// Adds what another situation gave.
    pub fn add(&mut self, other: Self) {
        self.counted += other.counted;
        self.wrong += other.wrong;
        self.interior += other.interior;
        self.situations += other.situations;
        for limit in other.limits {
            if !self.limits.contains(&limit) {
                self.limits.push(limit);
            }
        }
        self.failures.extend(other.failures);
    }

    /// Fails where more is wrong in all than is rare.
    pub fn settle(&mut self, expect: Expect) {
        let allowed = RARE * self.counted as f64;
        if matches!(expect, Expect::Rare(_)) && self.interior as f64 > allowed.max(1.0) {
            let Self {
                interior, counted, ..
            } = self;
            let failure = format!("{interior} of {counted} pixels are wrong, more than rare");
            self.failures.push(failure);
        }
    }

    /// Wrong pixels, edges included, in per cent of those that count.
    pub fn wrong_percent(&self) -> f64 {
        100.0 * self.wrong as f64 / self.counted.max(1) as f64
    }

    /// Interior errors in per cent of the pixels that count.
    pub fn interior_percent(&self) -> f64 {
        100.0 * self.interior as f64 / self.counted.max(1) as f64
    }
}
