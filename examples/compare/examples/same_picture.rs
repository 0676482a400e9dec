//! Compares two pictures: `same_picture A.png B.png` exits with 1 and prints how far they differ if they do
//! not show the same. Drivers may round a few edges differently; a scene that has changed is detected.

use std::process::ExitCode;

use anyhow::{Context as _, Result, ensure};

use host::image::read_png;
use host::terminal::note;

/// Levels of 255 by which a byte may differ.
const LEVELS: u8 = 8;
/// The part of the bytes that may differ by more.
const PART: f64 = 1e-3;

fn main() -> Result<ExitCode> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let [first, second] = paths.as_slice() else {
        anyhow::bail!("name two pictures");
    };
    let read = |path: &String| read_png(path.as_ref()).with_context(|| path.clone());
    let ((size, first), (other, second)) = (read(first)?, read(second)?);
    ensure!(
        size == other && first.len() == second.len(),
        "{}: {size:?} pixels, and not {other:?} or of other colours",
        paths.join(", ")
    );
    let pairs = first.iter().zip(&second);
    let apart = pairs.filter(|(a, b)| a.abs_diff(**b) > LEVELS).count();
    let part = apart as f64 / first.len() as f64;
    if part <= PART {
        return Ok(ExitCode::SUCCESS);
    }
    note(&format!(
        "{} differ in {:.2} % of their bytes",
        paths.join(" and "),
        100.0 * part
    ));
    Ok(ExitCode::FAILURE)
}
