//! The hard cases: what each is, and the answer that every technique should give.

mod camera;
mod light;
mod mesh;
mod place;
mod views;

use super::situation::Situation;
use crate::host::random::Random;

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
    pub volumes: Expect,
    /// Of volumes as textbooks have them, where they are not expected to do as well.
    pub textbook_volumes: Option<Expect>,
    pub maps: Expect,
    /// Of maps of 16 bits, which are tried only where this is not [`Expect::Nothing`].
    pub sixteen_bits: Expect,
}

/// What is expected of a kind of technique.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expect {
    /// Not one interior pixel is wrong.
    Exact,
    /// It cannot be right, for this reason; how wrong it is gets reported and is no failure.
    Reported(&'static str),
    /// At most four interior pixels of a million are wrong, for this reason.
    Rare(&'static str),
    /// Streaks of one pixel may be wrong, for this reason: no wrong interior pixel has a wrong
    /// neighbour both beside it and above or below it.
    Streaks(&'static str),
    /// Wrong only where the renderer says that its 8-bit counts may have wrapped.
    Wraps,
    /// Not tried.
    Nothing,
}

impl Case {
    const EXACT: Self = Self {
        name: "",
        build: "",
        answer: "",
        situations: |_| Vec::new(),
        volumes: Expect::Exact,
        textbook_volumes: None,
        maps: Expect::Exact,
        sixteen_bits: Expect::Nothing,
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
}
