//! Where each instance's facings, caps and sides lie in the shared buffers.

/// The three buffers of a chunk.
pub(super) const NAMES: [&str; 3] = ["facings", "caps", "sides"];

/// Words (4 bytes) of an instance in the three buffers of a chunk.
pub(super) type Words = [u64; 3];

/// First words of an instance's parts, and the chunk whose buffers they are in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub chunk: usize,
    pub facing: u32,
    pub cap: u32,
    pub side: u32,
}

/// A part that fits no buffer of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Overflow {
    pub what: &'static str,
    pub size: u64,
    pub limit: u64,
}

/// Hands out space in as few chunks as the device's limits allow, each part in one piece.
#[derive(Clone, Debug)]
pub(super) struct Regions {
    limit: Words,
    chunks: Vec<Words>,
}

impl Regions {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64) -> Self {
        let words = (bytes / 4).min(u64::from(u32::MAX));
        // A side is drawn with six vertices, and their number must fit 32 bits, too.
        let sides = words.min(u64::from(u32::MAX / 6));
        Self {
            limit: [words, words, sides],
            chunks: Vec::new(),
        }
    }

    /// Space for one instance.
    pub fn place(&mut self, need: Words) -> Result<Place, Overflow> {
        for ((what, size), limit) in NAMES.into_iter().zip(need).zip(self.limit) {
            if size > limit {
                return Err(Overflow {
                    what,
                    size: size.saturating_mul(4),
                    limit: limit * 4,
                });
            }
        }
        let fits = |used: &Words| (0..3).all(|i| need[i] <= self.limit[i] - used[i]);
        if !self.chunks.last().is_some_and(fits) {
            self.chunks.push([0; 3]);
        }
        let chunk = self.chunks.len() - 1;
        let used = &mut self.chunks[chunk];
        // Below the limits, which are below 2^32.
        let [facing, cap, side] = used.map(|words| words as u32);
        for (used, need) in used.iter_mut().zip(need) {
            *used += need;
        }
        Ok(Place {
            chunk,
            facing,
            cap,
            side,
        })
    }

    /// Words used in each chunk.
    pub fn chunks(&self) -> &[Words] {
        &self.chunks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_follow_each_other_and_spill_into_the_next_chunk() {
        let mut regions = Regions::new(400);
        let need = [10, 30, 8];
        let places: Vec<_> = (0..4).map(|_| regions.place(need).unwrap()).collect();
        let starts = |p: &Place| (p.chunk, p.facing, p.cap, p.side);
        assert_eq!(starts(&places[0]), (0, 0, 0, 0));
        assert_eq!(starts(&places[2]), (0, 20, 60, 16));
        assert_eq!(starts(&places[3]), (1, 0, 0, 0));
        assert_eq!(regions.chunks(), [[30, 90, 24], [10, 30, 8]]);
    }

    #[test]
    fn what_fits_no_buffer_is_named_and_takes_no_space() {
        let mut regions = Regions::new(400);
        let overflow = regions.place([10, 101, 0]).unwrap_err();
        assert_eq!(
            (overflow.what, overflow.size, overflow.limit),
            ("caps", 404, 400)
        );
        assert!(regions.chunks().is_empty());
        assert!(regions.place([100, 100, 100]).is_ok());
    }

    #[test]
    fn side_vertices_stay_countable_in_32_bits() {
        let mut regions = Regions::new(u64::MAX);
        assert_eq!(
            regions.place([0, 0, 715_827_883]).unwrap_err().what,
            "sides"
        );
        assert!(regions.place([0, 0, 715_827_882]).is_ok());
    }
}
