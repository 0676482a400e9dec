//! Where things lie in shared buffers: each volume's facings, caps and sides, each mesh's lists.

use std::collections::{BTreeMap, BTreeSet};

/// The three buffers of a chunk.
pub(crate) const NAMES: [&str; 3] = ["facings", "caps", "sides"];

/// Words (4 bytes) of a volume in the three buffers of a chunk.
pub(crate) type Words = [u64; 3];

/// First words of a volume's parts, and the chunk whose buffers they are in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    pub chunk: usize,
    pub facing: u32,
    pub cap: u32,
    pub side: u32,
}

/// A part that fits no buffer of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Overflow {
    pub what: &'static str,
    pub size: u64,
    pub limit: u64,
}

/// Hands out space in as few chunks as the device's limits allow, each part in one piece, and takes it
/// back: what comes and goes moves nothing else.
#[derive(Clone, Debug)]
pub(crate) struct Regions(Chunks<3>);

impl Regions {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64) -> Self {
        let words = (bytes / 4).min(u64::from(u32::MAX));
        // A side is drawn with six vertices, and their number must fit 32 bits, too.
        let sides = words.min(u64::from(u32::MAX / 6));
        Self(Chunks::new(NAMES, [4; 3], [words, words, sides]))
    }

    /// Whether one volume fits.
    pub fn check(&self, need: Words) -> Result<(), Overflow> {
        self.0.check(need)
    }

    /// Space for one volume that passed the [`check`](Self::check).
    pub fn take(&mut self, need: Words) -> Place {
        let (chunk, [facing, cap, side]) = self.0.take(need);
        Place {
            chunk,
            facing,
            cap,
            side,
        }
    }

    /// Takes space back that [`take`](Self::take) gave for as much.
    pub fn give_back(&mut self, place: &Place, words: Words) {
        let starts = [place.facing, place.cap, place.side];
        self.0.give_back((place.chunk, starts), words);
    }

    /// Words in each chunk up to the last that is taken.
    pub fn ends(&self) -> impl Iterator<Item = Words> {
        self.0.ends()
    }
}

/// Chunks of some lists each, in which things have a part in every list of one chunk.
#[derive(Clone, Debug)]
pub(crate) struct Chunks<const N: usize> {
    names: [&'static str; N],
    /// Bytes of an item of each list, and how many of them a buffer holds.
    item_bytes: [u64; N],
    limit: [u64; N],
    chunks: Vec<[Space; N]>,
}

impl<const N: usize> Chunks<N> {
    /// `limit`: items of each list in a chunk, below 2^32.
    pub fn new(names: [&'static str; N], item_bytes: [u64; N], limit: [u64; N]) -> Self {
        Self {
            names,
            item_bytes,
            limit,
            chunks: Vec::new(),
        }
    }

    /// Items of each list that a chunk holds.
    pub fn limit(&self) -> [u64; N] {
        self.limit
    }

    /// Whether so many items fit an empty chunk.
    pub fn check(&self, need: [u64; N]) -> Result<(), Overflow> {
        let lists = self.names.into_iter().zip(self.item_bytes);
        for ((what, bytes), (need, limit)) in lists.zip(need.into_iter().zip(self.limit)) {
            if need > limit {
                return Err(Overflow {
                    what,
                    size: need.saturating_mul(bytes),
                    limit: limit * bytes,
                });
            }
        }
        Ok(())
    }

    /// A chunk, and the first items there, of as many as passed the [`check`](Self::check).
    pub fn take(&mut self, need: [u64; N]) -> (usize, [u32; N]) {
        let limit = self.limit;
        let fits = |spaces: &[Space; N]| (0..N).all(|i| spaces[i].has(need[i], limit[i]));
        let chunk = self.chunks.iter().position(fits).unwrap_or_else(|| {
            self.chunks.push(std::array::from_fn(|_| Space::default()));
            self.chunks.len() - 1
        });
        let spaces = &mut self.chunks[chunk];
        // Below the limits, which are below 2^32.
        let starts = std::array::from_fn(|i| spaces[i].take(need[i]) as u32);
        (chunk, starts)
    }

    /// Takes space back that [`take`](Self::take) gave for as much.
    pub fn give_back(&mut self, (chunk, starts): (usize, [u32; N]), need: [u64; N]) {
        // What never was in a chunk has no items.
        let spaces = self.chunks.get_mut(chunk).into_iter().flatten();
        for ((space, start), count) in spaces.zip(starts).zip(need) {
            space.give_back(start.into(), count);
        }
    }

    /// Items in each chunk up to the last that is taken.
    pub fn ends(&self) -> impl Iterator<Item = [u64; N]> {
        let ends = |spaces: &[Space; N]| std::array::from_fn(|i| spaces[i].end);
        self.chunks.iter().map(ends)
    }
}

/// Items from 0 on: those before `end` are taken, but for holes.
#[derive(Clone, Debug, Default)]
struct Space {
    end: u64,
    /// The length of each hole by its start; no two touch, and none touches the end.
    holes: BTreeMap<u64, u64>,
    /// The same as length and start.
    by_length: BTreeSet<(u64, u64)>,
}

impl Space {
    /// The smallest hole that is large enough.
    fn hole(&self, need: u64) -> Option<(u64, u64)> {
        self.by_length.range((need, 0)..).next().copied()
    }

    fn has(&self, need: u64, limit: u64) -> bool {
        need <= limit - self.end || self.hole(need).is_some()
    }

    fn take(&mut self, need: u64) -> u64 {
        if need == 0 {
            return 0;
        }
        match self.hole(need) {
            Some((length, start)) => {
                self.close(start, length);
                if length > need {
                    self.open(start + need, length - need);
                }
                start
            }
            None => {
                self.end += need;
                self.end - need
            }
        }
    }

    fn give_back(&mut self, mut start: u64, mut length: u64) {
        if length == 0 {
            return;
        }
        let after = start + length;
        if let Some(&next) = self.holes.get(&after) {
            self.close(after, next);
            length += next;
        }
        let before = self.holes.range(..start).next_back();
        if let Some((&first, &previous)) =
            before.filter(|(first, length)| *first + *length == start)
        {
            self.close(first, previous);
            start = first;
            length += previous;
        }
        match start + length == self.end {
            true => self.end = start,
            false => self.open(start, length),
        }
    }

    fn open(&mut self, start: u64, length: u64) {
        self.holes.insert(start, length);
        self.by_length.insert((length, start));
    }

    fn close(&mut self, start: u64, length: u64) {
        self.holes.remove(&start);
        self.by_length.remove(&(length, start));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn parts_follow_each_other_and_spill_into_the_next_chunk() {
        let mut regions = Regions::new(400);
        let need = [10, 30, 8];
        let places: Vec<_> = (0..4).map(|_| regions.take(need)).collect();
        let starts = |p: &Place| (p.chunk, p.facing, p.cap, p.side);
        assert_eq!(starts(&places[0]), (0, 0, 0, 0));
        assert_eq!(starts(&places[2]), (0, 20, 60, 16));
        assert_eq!(starts(&places[3]), (1, 0, 0, 0));
        assert!(regions.ends().eq([[30, 90, 24], [10, 30, 8]]));
        regions.give_back(&places[1], need);
        assert_eq!(regions.take(need), places[1]);
    }

    #[test]
    fn what_fits_no_buffer_is_named() {
        let regions = Regions::new(400);
        let overflow = regions.check([10, 101, 0]).unwrap_err();
        assert_eq!(
            (overflow.what, overflow.size, overflow.limit),
            ("caps", 404, 400)
        );
        assert!(regions.check([100, 100, 100]).is_ok());
    }

    #[test]
    fn side_vertices_stay_countable_in_32_bits() {
        let regions = Regions::new(u64::MAX);
        assert_eq!(
            regions.check([0, 0, 715_827_883]).unwrap_err().what,
            "sides"
        );
        assert!(regions.check([0, 0, 715_827_882]).is_ok());
    }

    proptest! {
        #[test]
        fn nothing_overlaps_whatever_comes_and_goes(
            steps in prop::collection::vec((0_usize..40, prop::array::uniform3(0_u64..60)), 1..200),
        ) {
            let mut regions = Regions::new(400);
            let mut taken: Vec<(Place, Words)> = Vec::new();
            for (which, words) in steps {
                match which < taken.len() {
                    true => {
                        let (place, words) = taken.swap_remove(which);
                        regions.give_back(&place, words);
                    }
                    false => taken.push((regions.take(words), words)),
                }
                let ends: Vec<Words> = regions.ends().collect();
                for part in 0..3 {
                    let mut spans: Vec<_> = taken
                        .iter()
                        .map(|(p, words)| (p.chunk, [p.facing, p.cap, p.side][part], words[part]))
                        .filter(|(.., length)| *length > 0)
                        .collect();
                    spans.sort_unstable();
                    for pair in spans.windows(2) {
                        prop_assert!(
                            pair[0].0 < pair[1].0
                                || u64::from(pair[0].1) + pair[0].2 <= u64::from(pair[1].1)
                        );
                    }
                    for (chunk, start, length) in spans {
                        prop_assert!(u64::from(start) + length <= ends[chunk][part]);
                        prop_assert!(ends[chunk][part] <= 100);
                    }
                }
            }
            for (place, words) in taken {
                regions.give_back(&place, words);
            }
            prop_assert!(regions.ends().all(|ends| ends == [0; 3]));
        }
    }
}
