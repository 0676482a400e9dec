//! Random numbers that are the same for ever.

use shadows::glam::Vec3;

/// A small generator, so that a seed is a scene for ever (Steele et al., "Fast Splittable
/// Pseudorandom Number Generators", 2014).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn within(&mut self, from: f32, to: f32) -> f32 {
        from + (to - from) * ((self.next() >> 40) as f32 / (1 << 24) as f32)
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// In a cube around the origin.
    pub fn point(&mut self, half: f32) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.within(-half, half)))
    }
}
