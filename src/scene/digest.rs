//! Numbers that stand for what a tile shows.

/// 128 bits of any number of words. Two sequences that differ give the same with a chance of about 2^-128.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Digest([u64; 2]);

impl Digest {
    pub fn new() -> Self {
        Self([0x9e37_79b9_7f4a_7c15, 0xc2b2_ae3d_27d4_eb4f])
    }

    pub fn take(&mut self, word: u64) {
        for (lane, key) in self
            .0
            .iter_mut()
            .zip([0xa076_1d64_78bd_642f_u64, 0xe703_7ed1_a0b4_28db])
        {
            // Multiply and fold, as wyhash does (Wang Yi, 2019).
            let product = u128::from(*lane ^ word) * u128::from(key);
            *lane = (product as u64) ^ ((product >> 64) as u64) ^ word.rotate_left(32);
        }
    }

    pub fn take_f32(&mut self, numbers: &[f32]) {
        for pair in numbers.chunks(2) {
            let low = pair.get(1).map_or(0, |number| number.to_bits());
            self.take(u64::from(pair[0].to_bits()) << 32 | u64::from(low));
        }
    }

    pub fn finish(mut self) -> u128 {
        self.take(0);
        self.take(0);
        u128::from(self.0[0]) << 64 | u128::from(self.0[1])
    }
}
