//! The hard cases: what each is, and the answer that every technique should give.

mod camera;
mod depth;
mod flat;
mod frames;
mod light;
pub mod mesh;
mod place;
mod views;

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
    };
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
}
