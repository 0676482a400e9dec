//! Where in a texel and on the light the rays go: a Sobol' sequence in four dimensions.

/// Degree, inner coefficients and first direction integers of the primitive polynomials of the second to the fourth
/// dimension (Joe and Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", 2008).
const POLYNOMIALS: [(usize, u32, [u32; 3]); 3] =
    [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

/// A low-discrepancy sequence in the unit cube of four dimensions (Sobol' 1967): two for the place in the texel, two
/// for the place on the light.
#[derive(Clone, Debug)]
pub(super) struct Sequence {
    directions: [[u32; 32]; 4],
}

impl Sequence {
    pub fn new() -> Self {
        let mut directions = [[0; 32]; 4];
        for (bit, direction) in directions[0].iter_mut().enumerate() {
            *direction = 1 << (31 - bit);
        }
        for (own, (degree, inner, first)) in directions[1..].iter_mut().zip(POLYNOMIALS) {
            for bit in 0..32 {
                own[bit] = if bit < degree {
                    first[bit] << (31 - bit)
                } else {
                    let before = own[bit - degree];
                    let terms = (1..degree).filter(|k| inner >> (degree - 1 - k) & 1 == 1);
                    terms.fold(before ^ (before >> degree), |sum, k| sum ^ own[bit - k])
                };
            }
        }
        Self { directions }
    }

    /// The point of a number, shifted by `shift`: each coordinate in 0 to 1, 1 excluded. A digital shift keeps the
    /// sequence's evenness, and lets neighbouring texels have other points.
    pub fn point(&self, number: u32, shift: [u32; 4]) -> [f64; 4] {
        let scale = 1.0 / 4_294_967_296.0;
        std::array::from_fn(|axis| {
            let bits = (0..32).filter(|bit| number >> bit & 1 == 1);
            let place = bits.fold(0, |sum, bit| sum ^ self.directions[axis][bit]);
            // Half a step, so that the place is no border of the cells that the sequence counts in.
            (f64::from(place ^ shift[axis]) + 0.5) * scale
        })
    }
}

/// A shift of a texel's own, the same whenever and wherever it is computed (the finaliser of SplitMix64: Steele, Lea and
/// Flood 2014).
pub(super) fn shift(x: u32, y: u32) -> [u32; 4] {
    let mix = |mut z: u64| {
        z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let first = mix(u64::from(x) << 32 | u64::from(y));
    let second = mix(first);
    [
        first as u32,
        (first >> 32) as u32,
        second as u32,
        (second >> 32) as u32,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of the boxes of volume 1/16 whose sides are powers of two hold exactly one of 16 points.
    fn even_boxes(points: &[[f64; 4]], axes: [usize; 2]) -> (usize, usize) {
        let (mut even, mut all) = (0, 0);
        for columns in [1_usize, 2, 4, 8, 16] {
            let rows = 16 / columns;
            let mut counts = [0; 16];
            for point in points {
                let column = (point[axes[0]] * columns as f64) as usize;
                let row = (point[axes[1]] * rows as f64) as usize;
                counts[row * columns + column] += 1;
            }
            even += counts.iter().filter(|&&count| count == 1).count();
            all += 16;
        }
        (even, all)
    }

    #[test]
    fn every_elementary_box_of_the_texel_holds_one_point() {
        let sequence = Sequence::new();
        for (x, y) in [(0, 0), (7, 3), (1000, 999)] {
            let points: Vec<[f64; 4]> = (0..16)
                .map(|number| sequence.point(number, shift(x, y)))
                .collect();
            // The first two dimensions are a (0, m, 2)-net.
            let (even, all) = even_boxes(&points, [0, 1]);
            assert_eq!(even, all);
            // All dimensions are even by themselves.
            for axis in 0..4 {
                let mut cells: Vec<usize> =
                    points.iter().map(|p| (16.0 * p[axis]) as usize).collect();
                cells.sort();
                assert_eq!(cells, Vec::from_iter(0..16));
            }
            // The twin: shifts that are not one for all points.
            let broken: Vec<[f64; 4]> = (0..16)
                .map(|number| sequence.point(number, shift(number, y)))
                .collect();
            let (even, all) = even_boxes(&broken, [0, 1]);
            assert!(even < all * 3 / 4, "{even} of {all}");
        }
        assert_ne!(shift(1, 2), shift(2, 1));
    }
}
