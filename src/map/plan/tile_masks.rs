//! For each caster the tiles of a light that it touches, with a short way to those that touch any.

use crate::scene::Block;

const BITS: usize = u64::BITS as usize;

/// Those of one block in a word.
const BLOCK_BITS: u64 = (1 << Block::SIZE) - 1;

/// Masks of tiles by caster. Most are 0, so a bit says which are not, and another for each 64 of
/// those bits: what is found or forgotten takes a time that depends on how many touch a tile, and
/// on the others by a 4096th of a word each.
#[derive(Debug, Default)]
pub(crate) struct TileMasks {
    masks: Vec<u8>,
    some: Vec<u64>,
    any: Vec<u64>,
}

impl TileMasks {
    pub fn get(&self, index: usize) -> u8 {
        self.masks[index]
    }

    pub fn set(&mut self, index: usize, mask: u8) {
        self.masks[index] = mask;
        let word = &mut self.some[index / BITS];
        put(word, index % BITS, mask != 0);
        let any = *word != 0;
        put(&mut self.any[index / BITS / BITS], index / BITS % BITS, any);
    }

    /// Sets a mask that is 0.
    pub fn add(&mut self, index: usize, mask: u8) {
        self.masks[index] = mask;
        let some = u64::from(mask != 0);
        self.some[index / BITS] |= some << (index % BITS);
        self.any[index / BITS / BITS] |= some << (index / BITS % BITS);
    }

    /// Sets the masks of a block, which are 0, to the same.
    pub fn add_block(&mut self, block: usize, mask: u8) {
        let first = block * Block::SIZE;
        self.masks[first..first + Block::SIZE].fill(mask);
        let some = u64::from(mask != 0);
        self.some[first / BITS] |= (some * BLOCK_BITS) << (first % BITS);
        self.any[first / BITS / BITS] |= some << (first / BITS % BITS);
    }

    /// What all masks of a block are, if they are the same.
    pub fn of_block(&self, block: usize) -> Option<u8> {
        let masks = self.masks.as_chunks::<{ Block::SIZE }>().0.get(block)?;
        (*masks == [masks[0]; Block::SIZE]).then_some(masks[0])
    }

    /// The blocks of which any caster touches a tile, in order, and the casters of each that do. The last
    /// need not be a whole one.
    pub fn touching_blocks(&self) -> impl Iterator<Item = (usize, impl Iterator<Item = usize>)> {
        let words = self.any.iter().copied().enumerate().flat_map(bits);
        let blocks = words.flat_map(|at| {
            let word = self.some[at];
            let parts = (0..BITS / Block::SIZE).map(move |part| {
                let shift = part * Block::SIZE;
                (at * BITS + shift, word >> shift & BLOCK_BITS)
            });
            parts.filter(|(_, bits)| *bits != 0)
        });
        blocks.map(|(first, word)| {
            let casters = bits((0, word)).map(move |bit| first + bit);
            (first / Block::SIZE, casters)
        })
    }

    pub fn push(&mut self, mask: u8) {
        let index = self.masks.len();
        self.resize(index + 1);
        self.set(index, mask);
    }

    pub fn pop(&mut self) -> Option<u8> {
        let index = self.masks.len().checked_sub(1)?;
        let mask = self.masks[index];
        self.set(index, 0);
        self.resize(index);
        Some(mask)
    }

    /// Sets all masks to 0, and how many there are.
    pub fn reset(&mut self, count: usize) {
        let Self { masks, some, any } = self;
        let count_before = masks.len();
        for high in any.iter_mut().enumerate().flat_map(take_bits) {
            let first = high * BITS;
            match some[high].count_ones() {
                0..8 => bits((high, some[high])).for_each(|index| masks[index] = 0),
                _ => masks[first..(first + BITS).min(count_before)].fill(0),
            }
            some[high] = 0;
        }
        self.resize(count);
    }

    /// The casters that touch any tile of a mask, in order.
    pub fn touching(&self, mask: u8) -> impl Iterator<Item = usize> + '_ {
        let words = self.any.iter().copied().enumerate().flat_map(bits);
        words
            .flat_map(|at| bits((at, self.some[at])))
            .filter(move |&index| self.masks[index] & mask != 0)
    }

    /// New masks are 0; those cut off must be.
    fn resize(&mut self, count: usize) {
        self.masks.resize(count, 0);
        self.some.resize(count.div_ceil(BITS), 0);
        self.any.resize(self.some.len().div_ceil(BITS), 0);
    }
}

fn put(word: &mut u64, bit: usize, on: bool) {
    *word = *word & !(1 << bit) | u64::from(on) << bit;
}

/// The tiles of a mask.
pub(crate) fn tiles_of(mask: u8) -> impl Iterator<Item = usize> {
    bits((0, u64::from(mask)))
}

/// The places of the bits of word number `at`, counted through all words.
fn bits((at, mut word): (usize, u64)) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros() as usize;
        word &= word.wrapping_sub(1);
        (bit < BITS).then_some(at * BITS + bit)
    })
}

/// The same, leaving the word 0.
fn take_bits((at, word): (usize, &mut u64)) -> impl Iterator<Item = usize> + use<> {
    bits((at, std::mem::take(word)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[derive(Clone, Debug)]
    enum Step {
        Set(usize, u8),
        Add(usize, u8),
        Push(u8),
        Pop,
        Reset(usize),
    }

    fn step() -> impl Strategy<Value = Step> {
        prop_oneof![
            8 => (0..20_000_usize, 0..64_u8).prop_map(|(at, mask)| Step::Set(at, mask)),
            4 => (0..20_000_usize, 0..64_u8).prop_map(|(at, mask)| Step::Add(at, mask)),
            2 => (0..64_u8).prop_map(Step::Push),
            2 => Just(Step::Pop),
            1 => (0..10_000_usize).prop_map(Step::Reset),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn it_is_a_list_of_masks(
            start in 0..10_000_usize,
            steps in prop::collection::vec(step(), 1..200),
            tiles in 1..64_u8,
        ) {
            let mut masks = TileMasks::default();
            masks.reset(start);
            let mut list = vec![0; start];
            for step in steps {
                match step {
                    Step::Set(..) | Step::Add(..) if list.is_empty() => {}
                    Step::Add(at, mask) => {
                        let at = at % list.len();
                        if list[at] == 0 {
                            list[at] = mask;
                            masks.add(at, mask);
                        }
                    }
                    Step::Set(at, mask) => {
                        let at = at % list.len();
                        list[at] = mask;
                        masks.set(at, mask);
                    }
                    Step::Push(mask) => {
                        list.push(mask);
                        masks.push(mask);
                    }
                    Step::Pop => prop_assert_eq!(masks.pop(), list.pop()),
                    Step::Reset(count) => {
                        list = vec![0; count];
                        masks.reset(count);
                    }
                }
            }
            let expected: Vec<usize> =
                (0..list.len()).filter(|&at| list[at] & tiles != 0).collect();
            prop_assert_eq!(masks.touching(tiles).collect::<Vec<_>>(), expected);
            prop_assert!((0..list.len()).all(|at| masks.get(at) == list[at]));
        }
    }
}
