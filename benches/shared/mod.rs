//! What the benches share.
#![allow(dead_code)] // each of them uses its own part

pub mod torus;

use std::time::Duration;

/// Whether to take fewer rounds: `cargo bench -- --quick`.
pub fn quick() -> bool {
    std::env::args().any(|argument| argument == "--quick" || argument == "--test")
}

/// The mean of the middle two for an even count.
pub fn median(times: impl IntoIterator<Item = f64>) -> f64 {
    let mut times: Vec<f64> = times.into_iter().collect();
    times.sort_unstable_by(f64::total_cmp);
    let count = times.len();
    0.5 * (times[(count - 1) / 2] + times[count / 2])
}

/// The median of one over the other, round by round.
pub fn paired(ours: &[f64], theirs: &[f64]) -> f64 {
    let rounds = ours.iter().zip(theirs);
    median(rounds.map(|(ours, theirs)| ours / theirs))
}

pub fn seconds(times: &[Duration]) -> Vec<f64> {
    times.iter().map(Duration::as_secs_f64).collect()
}
