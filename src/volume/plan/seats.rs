//! In which draws a caster is.

use crate::mesh::MeshKind;
use crate::volume::decide::facing::Counted;
use crate::volume::plan::cache::Slot;
use crate::volume::plan::draw_lists::{DrawKey, DrawLists};
use crate::volume::plan::faces::{Draw, DrawnAs, Faces};
use crate::volume::plan::merged::{Member, MergedDraws, OWN_CAPS, Seat, Seated};
use crate::volume::plan::params::Arguments;
use crate::volume::silhouette::Way;

/// Kinds of faces that a caster has, at most: its sides and its light cap in two parts each, and a dark
/// cap; or its sides, and two lists each of light and dark caps.
const MOST: usize = 5;

/// The same, for sums of bytes.
pub(crate) const SEATS_OF_CASTER: u64 = MOST as u64;

/// The seats of a caster.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seats([Option<Seat>; MOST]);

impl Seats {
    /// Takes the seats that the caster needs, its volume having its place; those that it has and can stay
    /// on stay its own.
    pub fn update(
        &mut self,
        (drawn_as, side_vertices): (DrawnAs, u32),
        slot: &Slot,
        (lists, merged): (&mut DrawLists, &mut MergedDraws),
    ) {
        let mut seats = self.0.iter_mut();
        drawn_as.draws(|draw| {
            let Some(seat) = seats.next() else { return };
            let key = key(&draw, slot, side_vertices);
            let seated = seated(&draw, slot, key.own);
            if let Some(had) = *seat {
                if merged.keep(had, &key, seated, slot.is_new()) {
                    return;
                }
                merged.leave(lists, had);
            }
            *seat = Some(merged.seat(lists, key, seated));
        });
        for left in seats.filter_map(Option::take) {
            merged.leave(lists, left);
        }
    }

    /// Gives them all back.
    pub fn leave(&mut self, lists: &mut DrawLists, merged: &mut MergedDraws) {
        for left in self.0.iter_mut().filter_map(Option::take) {
            merged.leave(lists, left);
        }
    }
}

fn key(draw: &Draw, slot: &Slot, side_vertices: u32) -> DrawKey {
    let caps = draw.style.faces.are_caps();
    DrawKey {
        way: slot.way,
        style: draw.style,
        vertices: match draw.style.faces {
            Faces::Sides => side_vertices,
            Faces::Fan | Faces::LightCap | Faces::DarkCap => 3,
        },
        back: draw.back,
        own: slot.way == Way::Vertex || caps && slot.mesh.triangle_count() >= OWN_CAPS,
        sources: slot.sources(),
    }
}

/// A caster in a draw of its own has nothing but its number.
fn seated(draw: &Draw, slot: &Slot, own: bool) -> Seated {
    let caps = draw.style.faces.are_caps();
    let member = Member {
        caster: draw.window,
        count: 0,
        start: 0,
        grows_down: 0,
    };
    if own {
        return Seated {
            member,
            elements: 1,
        };
    }
    let (place, counts) = (slot.place, slot.counts);
    if slot.way == Way::Cpu {
        let (count, start) = match (caps, draw.back) {
            (false, _) => (counts.sides, place.side),
            (true, false) => (counts.front, place.cap),
            (true, true) => (counts.back, place.cap + counts.front),
        };
        let words = if caps { 3 } else { 1 };
        return Seated {
            member: Member {
                count,
                start,
                ..member
            },
            elements: u64::from(count / words),
        };
    }
    let (list, start) = match (caps, draw.back) {
        (false, _) => (Arguments::SIDES, place.side),
        (true, false) => (Arguments::FRONT, place.cap),
        (true, true) => (Arguments::BACK, place.cap + 3 * slot.mesh.triangle_count()),
    };
    // The arguments of all volumes fit a storage buffer.
    let words = (size_of::<Arguments>() / 4) as u32;
    Seated {
        member: Member {
            count: slot.instance.arguments * words + (list / 4) as u32,
            start,
            grows_down: u32::from(caps && draw.back),
            ..member
        },
        elements: match caps {
            true => slot.mesh.triangle_count().into(),
            false => most_sides(slot),
        },
    }
}

/// Sides of a volume that compute shaders find, at most.
fn most_sides(slot: &Slot) -> u64 {
    match slot.mesh.kind() {
        MeshKind::Closed if slot.instance.both_sides != Counted::All as u32 => {
            slot.mesh.edge_count().into()
        }
        MeshKind::Closed => 2 * u64::from(slot.mesh.edge_count()),
        MeshKind::General => slot.mesh.edge_use_count().into(),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec4;

    use super::*;
    use crate::volume::decide::far_end::FarEnd;
    use crate::volume::decide::method::{Count, DarkCap, Form};

    #[test]
    fn no_caster_needs_more_seats_than_there_are() {
        let mut most = 0;
        for count in [Count::Pass, Count::Fail] {
            for dark_cap in [DarkCap::None, DarkCap::Fan, DarkCap::Full] {
                for counted in [Counted::LightFacing, Counted::All, Counted::AwayFacing] {
                    for way in [Way::Compute, Way::Cpu, Way::Vertex] {
                        let form = Form {
                            count,
                            dark_cap,
                            light_cap_clipped: false,
                            side_vertices: 6,
                            far: FarEnd {
                                plane: DVec4::ZERO,
                                apex: DVec4::ZERO,
                            },
                        };
                        let drawn_as = DrawnAs::new(0, &form, (counted, way), (false, false));
                        let mut draws = 0;
                        drawn_as.draws(|_| draws += 1);
                        most = most.max(draws);
                    }
                }
            }
        }
        assert_eq!(most, MOST);
    }
}
