//! What came out, against what is expected.

use std::fmt::Write as _;

use anyhow::Result;
use shadows::glam::DVec3;
use shadows::reference::{Class, Comparison, Interior, ReferenceImage, Verdict as PixelVerdict};

use super::expect::Expect;
use super::outcome::Outcome;

/// What one technique's frame gave.
pub struct Frame<'a> {
    pub visibility: &'a [u8],
    pub interior: Interior,
    /// Whether the renderer says that its 8-bit counts may be wrong.
    pub may_wrap: bool,
    /// Where the light is and how far it reaches, if the technique says itself that nothing is lit
    /// beyond.
    pub reach: Option<(DVec3, f32)>,
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
    let lit = Lit {
        visibility: frame.visibility,
        may_wrap: frame.may_wrap,
        reach: frame.reach,
    };
    Ok(judge_found(what, reference, &found, &lit, expect))
}

/// What a picture says where the comparison with the reference does not ask.
pub struct Lit<'a> {
    pub visibility: &'a [u8],
    /// See [`Frame::may_wrap`].
    pub may_wrap: bool,
    /// See [`Frame::reach`].
    pub reach: Option<(DVec3, f32)>,
}

/// Judges by a comparison with the reference.
pub fn judge_found(
    what: &str,
    reference: &ReferenceImage,
    found: &Comparison,
    lit: &Lit<'_>,
    expect: Expect,
) -> Outcome {
    let unlit = lit_where_nothing_can_be(reference, lit);
    let mut outcome = Outcome {
        counted: found.lit_facing,
        wrong: found.false_lit + found.false_shadow + unlit,
        false_lit: found.false_lit_interior + unlit,
        false_shadow: found.false_shadow_interior,
        situations: 1,
        ..Outcome::default()
    };
    let interior = outcome.interior();
    let excuse = match expect {
        // Whether it is within its bound is asked of a round; loss that no interior pixel sees is
        // to be said, too.
        Expect::Limit(limit) if outcome.wrong > 0 => Some(limit.why),
        _ if interior == 0 => return outcome,
        Expect::Rare(why) => Some(why),
        Expect::Streaks(why) if !has_blocks(found, reference.width() as usize) => Some(why),
        Expect::Wraps if lit.may_wrap && only_falsely_lit(&outcome, unlit) => {
            Some("8-bit counts wrap at 256, which `may_wrap` reports")
        }
        _ => None,
    };
    match excuse {
        Some(why) => outcome.limits.push(why),
        None => outcome.failures.push(format!(
            "{what}: {interior} interior pixels are wrong{}",
            places(reference, found)
        )),
    }
    outcome
}

/// The first few wrong interior pixels: where in the picture, and what is seen there.
fn places(reference: &ReferenceImage, found: &Comparison) -> String {
    let mut places = String::new();
    let interior = found.verdicts.iter().enumerate().filter(|(_, verdict)| {
        matches!(
            verdict,
            PixelVerdict::FalseLitInterior | PixelVerdict::FalseShadowInterior
        )
    });
    for (pixel, verdict) in interior.take(6) {
        let (x, y) = (
            pixel as u32 % reference.width(),
            pixel as u32 / reference.width(),
        );
        let lit = match verdict {
            PixelVerdict::FalseLitInterior => "lit",
            _ => "dark",
        };
        let _ = write!(places, "; {lit} at {x},{y}");
        if let Some(hit) = reference.hit(x, y) {
            let _ = write!(places, " (object {}, {:.6})", hit.object, hit.position);
        }
    }
    places
}

/// A count that wraps reads 0, which is lit; it makes no shadow, and nothing of nothing.
fn only_falsely_lit(outcome: &Outcome, unlit: usize) -> bool {
    outcome.false_shadow == 0 && unlit == 0
}

/// Pixels that are lit where the reference sees nothing or what is beyond the light's range, nor
/// anything else beside it: edges are rounded to parts of a pixel.
fn lit_where_nothing_can_be(reference: &ReferenceImage, lit: &Lit<'_>) -> usize {
    let (width, height) = (reference.width() as usize, reference.height() as usize);
    let unlit: Vec<bool> = reference
        .classes()
        .enumerate()
        .map(|(pixel, class)| match class {
            Class::Background => true,
            Class::OutOfRange => is_beyond(reference, pixel, lit.reach),
            _ => false,
        })
        .collect();
    let around = |place: usize, end: usize| place.saturating_sub(1)..(place + 2).min(end);
    let alone = |pixel: usize| {
        let mut rows = around(pixel / width, height);
        rows.all(|row| around(pixel % width, width).all(|column| unlit[row * width + column]))
    };
    (0..unlit.len())
        .filter(|&pixel| lit.visibility[pixel] != 0 && alone(pixel))
        .count()
}

/// Whether a pixel is farther away than the range by what `f32` tells apart; those outside a cone
/// need not be.
fn is_beyond(reference: &ReferenceImage, pixel: usize, reach: Option<(DVec3, f32)>) -> bool {
    let Some((light, range)) = reach else {
        return false;
    };
    let place = [
        pixel as u32 % reference.width(),
        pixel as u32 / reference.width(),
    ];
    let hit = reference.hit(place[0], place[1]);
    // From the middle between the range and the next number, which would be rounded to the latter.
    let end = 0.5 * (f64::from(range) + f64::from(range.next_up()));
    hit.is_some_and(|hit| hit.position.distance(light) > end)
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
