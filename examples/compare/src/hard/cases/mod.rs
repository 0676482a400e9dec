//! The hard cases: what each is, and the answer that every technique should give.

mod atlas;
mod camera;
mod cascades;
mod depth;
mod flat;
mod frames;
mod light;
pub mod mesh;
mod place;
mod views;

use super::atlas::Frames;
use anyhow::{Result, ensure};

pub use super::course::Course;
use super::expect::Expect;
use super::situation::Situation;
use host::random::Random;

/// A case for numerical stability.
#[derive(Clone, Copy)]
pub struct Case {
    pub name: &'static str,
    /// How it is built.
    pub build: &'static str,
    /// The right answer.
    pub answer: &'static str,
    /// Some scenes of it, other ones each time.
    pub situations: fn(&mut Random) -> Vec<Situation>,
    /// But for the known limits, as for maps.
    pub volumes: Expect,
    pub maps: Expect,
    /// Whether maps of 16 bits are tried, too.
    pub sixteen_bits: bool,
    /// Whether maps of 4096 texels are tried, too.
    pub fine: bool,
    /// Which of the cheap and baked techniques are tried: where it shows what each can and cannot do.
    pub cheap: &'static [&'static str],
    /// Whether cube maps are asked if their seams are worse than their faces.
    pub seams: bool,
    /// What a technique has been through before.
    pub course: Course,
    /// In place of situations, what an atlas goes through; other techniques are not tried.
    pub frames: Option<fn(&mut Random) -> Vec<Frames>>,
}

impl Case {
    const EXACT: Self = Self {
        name: "",
        build: "",
        answer: "",
        situations: |_| Vec::new(),
        volumes: Expect::Exact,
        maps: Expect::Exact,
        sixteen_bits: false,
        fine: false,
        cheap: &[],
        seams: false,
        course: Course::Fresh,
        frames: None,
    };
}

/// Those whose name begins with one of these, or all where none is given.
///
/// # Errors
/// If none begins so.
pub fn chosen(starts: &[String]) -> Result<Vec<Case>> {
    for start in starts {
        let known = all().any(|case| case.name.starts_with(start.as_str()));
        ensure!(known, "no hard case's name begins with {start:?}");
    }
    let asked = |case: &Case| {
        let mut starts = starts.iter();
        starts.len() == 0 || starts.any(|start| case.name.starts_with(start.as_str()))
    };
    Ok(all().filter(asked).collect())
}

/// Every case, in the order of the table.
pub fn all() -> impl Iterator<Item = Case> {
    camera::CASES
        .into_iter()
        .chain(light::CASES)
        .chain(mesh::CASES)
        .chain(place::CASES)
        .chain(views::CASES)
        .chain(frames::CASES)
        .chain(flat::CASES)
        .chain(depth::CASES)
        .chain(atlas::CASES)
        .chain(cascades::CASES)
}
