//! Welding: vertices at one position become one.
//!
//! Open addressing over a hash of the three coordinates' bits. A slot keeps 32 bits of the hash
//! beside the vertex, so that two vertices are compared only when they are almost surely equal,
//! and a place in the table is the *top* bits of the hash, so that a table grows by streaming
//! through the old one in order.

/// The lowest-indexed vertex at the position of each vertex. The positions hold no NaN and no -0.
pub(super) fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut table = Table::new();
    // The list comes first in the zip: a counter in front would pass the last u32.
    positions
        .iter()
        .zip(0u32..)
        .map(|(position, vertex)| {
            table.find_or_insert(hash(position.map(f32::to_bits)), vertex, |other| {
                positions[other as usize] == *position
            })
        })
        .collect()
}

/// 32 well mixed bits: the folded product of wyhash (Wang Yi, 2019) over all 96 bits.
pub(super) fn hash([x, y, z]: [u32; 3]) -> u32 {
    let low = (u64::from(x) | u64::from(y) << 32) ^ 0xa076_1d64_78bd_642f;
    let high = u64::from(z) ^ 0xe703_7ed1_a0b4_28db;
    let product = u128::from(low) * u128::from(high);
    let folded = (product as u64) ^ (product >> 64) as u64;
    (folded.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as u32
}

/// No vertex has the number `u32::MAX`, so no slot in use looks like this.
const EMPTY: u64 = u64::MAX;

struct Table {
    /// `hash << 32 | vertex`, or [`EMPTY`].
    slots: Vec<u64>,
    /// A hash shifted right by this is its place.
    shift: u32,
    used: usize,
}

impl Table {
    fn new() -> Self {
        Self::with_bits(10)
    }

    fn with_bits(bits: u32) -> Self {
        Self {
            slots: vec![EMPTY; 1 << bits],
            shift: 32 - bits,
            used: 0,
        }
    }

    /// The vertex with this hash that is `equal`, or else `vertex` itself, which is then put in.
    fn find_or_insert(&mut self, hash: u32, vertex: u32, equal: impl Fn(u32) -> bool) -> u32 {
        let mask = self.slots.len() - 1;
        let mut place = (hash >> self.shift) as usize;
        loop {
            let slot = self.slots[place & mask];
            if slot == EMPTY {
                break;
            }
            if (slot >> 32) as u32 == hash && equal(slot as u32) {
                return slot as u32;
            }
            place += 1;
        }
        self.slots[place & mask] = u64::from(hash) << 32 | u64::from(vertex);
        self.used += 1;
        if self.used * 2 > self.slots.len() && self.shift > 0 {
            self.grow();
        }
        vertex
    }

    fn grow(&mut self) {
        let mut larger = Self::with_bits(33 - self.shift);
        larger.used = self.used;
        let mask = larger.slots.len() - 1;
        for &slot in self.slots.iter().filter(|&&slot| slot != EMPTY) {
            let mut place = ((slot >> 32) as u32 >> larger.shift) as usize;
            while larger.slots[place & mask] != EMPTY {
                place += 1;
            }
            larger.slots[place & mask] = slot;
        }
        *self = larger;
    }
}
