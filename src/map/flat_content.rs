//! What a flat map is asked for, what that comes to, and what its texels show.

use super::flat_descriptor::{FlatLight, ShadowFrame};
use super::flat_frame::FlatFrame;
use super::scene::Record;
use crate::View;
use crate::mesh::Bounds;

/// All of a frame but its casters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Asked {
    light: FlatLight,
    view: Option<(View, f32)>,
    receivers: Option<Bounds>,
}

impl Asked {
    pub fn of(frame: &ShadowFrame<'_>) -> Self {
        Self {
            light: frame.light,
            view: frame.view.map(|(view, distance)| (*view, distance)),
            receivers: frame.receivers,
        }
    }
}

/// The casters on a map, as a sum that their order does not change, and where the map lies. `None`
/// where there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Content(Option<Shown>);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shown {
    frame: FlatFrame,
    digests: u128,
    casters: u32,
}

/// What a map's texels show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Texels {
    /// Nobody knows.
    Unknown,
    /// No caster.
    Clear,
    Show(Shown),
}

impl Content {
    pub fn of(frame: Option<FlatFrame>, records: &[Record]) -> Self {
        let shown = frame.map(|frame| {
            let none = Shown {
                frame,
                digests: 0,
                casters: 0,
            };
            let on_map = records.iter().filter(|record| frame.holds(record));
            on_map.fold(none, |sum, record| Shown {
                digests: sum.digests.wrapping_add(record.digest),
                casters: sum.casters + 1,
                ..sum
            })
        });
        Self(shown.filter(|shown| shown.casters > 0))
    }

    pub fn casters(self) -> u32 {
        self.0.map_or(0, |shown| shown.casters)
    }

    pub fn on_texels(self) -> Texels {
        self.0.map_or(Texels::Clear, Texels::Show)
    }
}
