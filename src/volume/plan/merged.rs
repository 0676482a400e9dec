//! Draws that casters share: the faces of one pipeline, under one light in one view.
//!
//! An instance of such a draw is a block of up to [`BLOCK`] elements, sides or triangles of a cap, of one
//! caster. Which blocks there are follows from what the lists came to, so the GPU writes them where it
//! found the lists, and the CPU where the CPU did. A draw has so few casters that what one of them
//! changes is made anew at once, by one workgroup.

use std::collections::BTreeSet;

use bytemuck::{Pod, Zeroable};

use crate::volume::plan::draw_lists::{DrawKey, DrawLists};
use crate::volume::plan::limits::WORKGROUP;
use crate::volume::plan::ranges::Chunks;
use crate::volume::silhouette::Way;

/// Elements in a block. Small, for a box has but four to six sides; large enough that few of the vertices
/// of a wave are another block's.
pub(crate) const BLOCK: u32 = 8;

/// Bytes of a block: a caster, the first word of its elements, their number.
pub(crate) const BLOCK_BYTES: u64 = 12;

/// Bytes of the arguments of a draw.
pub(crate) const DRAW_BYTES: u64 = 16;

/// Triangles from which on a mesh's caps are drawn by themselves: there are indices, and with them a vertex
/// is not extruded for each triangle that has it, which of so many is worth more than a draw.
pub(crate) const OWN_CAPS: u32 = 1024;

/// Casters in a draw, at most: each is an invocation of a workgroup.
const SEATS: u64 = WORKGROUP as u64;

/// The three buffers of a chunk.
const NAMES: [&str; 3] = ["members", "blocks", "draws"];

/// A caster in a draw. `Member` in `volume_merge.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Member {
    /// The number of its window.
    pub caster: u32,
    /// How many words its list has, or the word of the arguments that says so.
    pub count: u32,
    /// The list's first word, or the word behind its last where it grows down.
    pub start: u32,
    pub grows_down: u32,
}

impl Member {
    /// None: where the GPU looks for its count, there is none.
    const NONE: Self = Self {
        caster: 0,
        count: u32::MAX,
        start: 0,
        grows_down: 0,
    };
}

/// A caster as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Seated {
    pub member: Member,
    /// Elements of its list, at most.
    pub elements: u64,
}

impl Seated {
    fn blocks(&self) -> u64 {
        self.elements.div_ceil(BLOCK.into())
    }
}

/// A caster's place in a draw: the draw's number, and which of its seats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Seat {
    draw: u32,
    place: u32,
}

/// One draw call.
#[derive(Debug)]
pub(crate) struct MergedDraw {
    pub key: DrawKey,
    /// Seats stay where they are; those of casters that left are taken first.
    seats: Vec<Option<Seated>>,
    taken: usize,
    /// Blocks, at most.
    most: u64,
    /// Items of each list of its chunk that it has room for, and where.
    room: [u64; 3],
    place: (usize, [u32; 3]),
    /// Seats to be written.
    changed: BTreeSet<u32>,
}

/// All of them, by numbers that stay theirs.
#[derive(Debug)]
pub(crate) struct MergedDraws {
    draws: Vec<Option<MergedDraw>>,
    free: Vec<u32>,
    /// Those to be made anew, some of them more than once, some no longer.
    touched: Vec<u32>,
    chunks: Chunks<3>,
}

impl MergedDraw {
    /// The casters, with their seats.
    pub fn members(&self) -> impl Iterator<Item = &Member> {
        self.seats.iter().flatten().map(|seated| &seated.member)
    }

    /// The window of the only caster, or of the first.
    pub fn first(&self) -> Option<u32> {
        Some(self.members().next()?.caster)
    }

    /// How many seats the merge pass has to look at.
    pub fn seats(&self) -> u32 {
        self.seats.len() as u32
    }

    pub fn chunk(&self) -> usize {
        self.place.0
    }

    /// Where members, blocks and arguments lie in the chunk.
    pub fn starts(&self) -> [u32; 3] {
        self.place.1
    }

    /// Bytes of its blocks, and the first.
    pub fn block_bytes(&self) -> std::ops::Range<u64> {
        let first = u64::from(self.place.1[1]) * BLOCK_BYTES;
        first..first + self.room[1] * BLOCK_BYTES
    }

    /// The blocks of what the CPU found.
    pub fn blocks(&self) -> Vec<[u32; 3]> {
        let words = self.key.element_words();
        let mut blocks = Vec::new();
        for member in self.members() {
            let elements = member.count / words;
            let firsts = (0..elements).step_by(BLOCK as usize);
            blocks.extend(firsts.map(|first| {
                let count = BLOCK.min(elements - first);
                [member.caster, member.start + first * words, count]
            }));
        }
        blocks
    }

    /// How many there are of them.
    pub fn block_count(&self) -> u32 {
        // Below the room for them, whose bytes are a buffer's.
        self.most as u32
    }

    /// Whether anything was not written.
    pub fn is_changed(&self) -> bool {
        !self.changed.is_empty()
    }

    /// What was not written: from which seat on, and what.
    pub fn changed(&self) -> Vec<(u32, Vec<Member>)> {
        let changed: Vec<u32> = self.changed.iter().copied().collect();
        let seated = |seat: &u32| self.seats.get(*seat as usize).copied().flatten();
        let member = |seat: &u32| seated(seat).map_or(Member::NONE, |seated| seated.member);
        let runs = changed.chunk_by(|a, b| a + 1 == *b);
        runs.map(|run| (run[0], run.iter().map(member).collect()))
            .collect()
    }

    fn set(&mut self, place: u32, new: Option<Seated>) {
        let seat = &mut self.seats[place as usize];
        let [old, now] = [&*seat, &new].map(|s| s.map_or(0, |seated| seated.blocks()));
        self.taken = self.taken + usize::from(new.is_some()) - usize::from(seat.is_some());
        self.most = self.most + now - old;
        *seat = new;
        self.changed.insert(place);
    }

    /// What it needs of each list of its chunk.
    fn needs(&self, limits: [u64; 3]) -> [u64; 3] {
        let room = |count: u64, most: u64| count.next_power_of_two().min(most);
        let blocks = room(self.most, limits[1]);
        match (self.key.way, self.key.own) {
            (Way::Vertex, _) => [0; 3],
            (_, true) => [0, 1, 0],
            (Way::Cpu, _) => [0, blocks, 0],
            (Way::Compute, _) => [room(self.seats.len() as u64, limits[0]), blocks, 1],
        }
    }
}

impl MergedDraws {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64) -> Self {
        let item_bytes = [size_of::<Member>() as u64, BLOCK_BYTES, DRAW_BYTES];
        // Shaders count in words of 32 bits.
        let bytes = bytes.min(u64::from(u32::MAX) * 4);
        Self {
            draws: Vec::new(),
            free: Vec::new(),
            touched: Vec::new(),
            chunks: Chunks::new(NAMES, item_bytes, item_bytes.map(|each| bytes / each)),
        }
    }

    pub fn get(&self, number: u32) -> Option<&MergedDraw> {
        self.draws.get(number as usize)?.as_ref()
    }

    /// Items of each list in each chunk up to the last that is taken.
    pub fn ends(&self) -> impl Iterator<Item = [u64; 3]> {
        self.chunks.ends()
    }

    /// A seat in one of the draws of this key, or in a new one.
    pub fn seat(&mut self, lists: &mut DrawLists, key: DrawKey, seated: Seated) -> Seat {
        let [most_seats, most_blocks, _] = self.chunks.limit();
        let most_seats = match key.own {
            true => 1,
            false => SEATS.min(most_seats) as usize,
        };
        let has_room = |draw: &MergedDraw| {
            draw.taken < most_seats && draw.most + seated.blocks() <= most_blocks
        };
        let list = lists.of(&key);
        let found = match key.own {
            true => None,
            false => list
                .iter()
                .copied()
                .find(|&n| self.get(n).is_some_and(has_room)),
        };
        let number = found.unwrap_or_else(|| {
            let number = self.add(key);
            list.insert(number);
            number
        });
        let mut place = 0;
        if let Some(draw) = self.draws[number as usize].as_mut() {
            let free = match draw.taken < draw.seats.len() {
                true => draw.seats.iter().position(Option::is_none),
                false => None,
            };
            let free = free.unwrap_or_else(|| {
                draw.seats.push(None);
                draw.seats.len() - 1
            });
            place = free as u32;
            draw.set(place, Some(seated));
        }
        self.touched.push(number);
        Seat {
            draw: number,
            place,
        }
    }

    /// Has the caster in this seat drawn as it is now, which may have another list than before. Whether it
    /// can keep the seat.
    pub fn keep(&mut self, seat: Seat, key: &DrawKey, seated: Seated, is_found: bool) -> bool {
        let [_, most_blocks, _] = self.chunks.limit();
        let draw = self.draws.get_mut(seat.draw as usize);
        let draw = draw.and_then(Option::as_mut);
        let Some(draw) = draw.filter(|draw| draw.key == *key) else {
            return false;
        };
        let Some(&Some(old)) = draw.seats.get(seat.place as usize) else {
            return false;
        };
        if draw.most - old.blocks() + seated.blocks() > most_blocks {
            return false;
        }
        if old != seated {
            draw.set(seat.place, Some(seated));
        }
        // A list that was found anew may have another length, wherever it lies.
        if old != seated || (is_found && key.way == Way::Compute && !key.own) {
            self.touched.push(seat.draw);
        }
        true
    }

    /// Takes a seat back; a draw without any is no more.
    pub fn leave(&mut self, lists: &mut DrawLists, seat: Seat) {
        let draw = self.draws.get_mut(seat.draw as usize);
        let Some(draw) = draw.and_then(Option::as_mut) else {
            return;
        };
        draw.set(seat.place, None);
        if draw.taken > 0 {
            self.touched.push(seat.draw);
            return;
        }
        lists.remove(&draw.key, seat.draw);
        self.chunks.give_back(draw.place, draw.room);
        self.draws[seat.draw as usize] = None;
        self.free.push(seat.draw);
    }

    /// Has all of them written and made anew, as what was written may be lost.
    pub fn renew(&mut self) {
        for (number, draw) in (0..).zip(&mut self.draws) {
            if let Some(draw) = draw {
                draw.changed.extend(0..draw.seats.len() as u32);
                self.touched.push(number);
            }
        }
    }

    /// Gives those room that changed. Their numbers, in order.
    pub fn settle(&mut self) -> Vec<u32> {
        let mut touched = std::mem::take(&mut self.touched);
        touched.sort_unstable();
        touched.dedup();
        touched.retain(|&number| self.get(number).is_some());
        for &number in &touched {
            let Some(draw) = self.draws[number as usize].as_mut() else {
                continue;
            };
            let needs = draw.needs(self.chunks.limit());
            if needs.iter().zip(draw.room).any(|(need, room)| *need > room) {
                self.chunks.give_back(draw.place, draw.room);
                draw.place = self.chunks.take(needs);
                draw.room = needs;
                draw.changed.extend(0..draw.seats.len() as u32);
            }
        }
        touched
    }

    /// Forgets what was to be written, as that is done.
    pub fn finish(&mut self, touched: &[u32]) {
        for &number in touched {
            if let Some(draw) = self.draws[number as usize].as_mut() {
                draw.changed.clear();
            }
        }
    }

    fn add(&mut self, key: DrawKey) -> u32 {
        let number = self.free.pop().unwrap_or_else(|| {
            self.draws.push(None);
            self.draws.len() as u32 - 1
        });
        self.draws[number as usize] = Some(MergedDraw {
            key,
            seats: Vec::new(),
            taken: 0,
            most: 0,
            room: [0; 3],
            place: (0, [0; 3]),
            changed: BTreeSet::new(),
        });
        number
    }
}

#[cfg(test)]
#[path = "merged_tests.rs"]
mod tests;
