//! Weights of the square kernels.

/// Weights of pairs of texels along an axis, linear in the place `s` between texels: for each pair,
/// constants and factors of `s` for its first and its second texel. Their scale does not matter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    pairs: usize,
    first: [f32; 4],
    first_s: [f32; 4],
    second: [f32; 4],
    second_s: [f32; 4],
}

impl Weights {
    /// One tap.
    pub const BILINEAR: Self = Self {
        pairs: 1,
        first: [1.0, 0.0, 0.0, 0.0],
        first_s: [-1.0, 0.0, 0.0, 0.0],
        second: [0.0; 4],
        second_s: [1.0, 0.0, 0.0, 0.0],
    };
    /// Four taps, one texel away on the diagonals.
    pub const FOUR_TAPS: Self = Self {
        pairs: 2,
        first: [1.0, 1.0, 0.0, 0.0],
        first_s: [-1.0, -1.0, 0.0, 0.0],
        second: [0.0; 4],
        second_s: [1.0, 1.0, 0.0, 0.0],
    };
    // What the published taps come to texel by texel (Castano 2013).
    pub const WEIGHTED_3: Self = Self {
        pairs: 2,
        first: [1.0, 1.0, 0.0, 0.0],
        first_s: [-1.0, 1.0, 0.0, 0.0],
        second: [2.0, 0.0, 0.0, 0.0],
        second_s: [-1.0, 1.0, 0.0, 0.0],
    };
    pub const WEIGHTED_5: Self = Self {
        pairs: 3,
        first: [1.0, 4.0, 1.0, 0.0],
        first_s: [-1.0, -1.0, 2.0, 0.0],
        second: [3.0, 3.0, 0.0, 0.0],
        second_s: [-2.0, 1.0, 1.0, 0.0],
    };
    pub const WEIGHTED_7: Self = Self {
        pairs: 4,
        first: [1.0, 12.0, 12.0, 1.0],
        first_s: [-1.0, -7.0, 4.0, 4.0],
        second: [5.0, 16.0, 5.0, 0.0],
        second_s: [-4.0, -4.0, 7.0, 1.0],
    };

    /// Constants for `pcf_square.wgsl`.
    pub fn wgsl(&self) -> String {
        let vector = |name, values: &[f32; 4]| {
            let [a, b, c, d] = values;
            format!("const shadows_cube_{name} = vec4f({a:?}, {b:?}, {c:?}, {d:?});\n")
        };
        format!("const shadows_cube_pairs = {};\n", self.pairs)
            + &vector("first", &self.first)
            + &vector("first_s", &self.first_s)
            + &vector("second", &self.second)
            + &vector("second_s", &self.second_s)
            + &format!("const shadows_cube_per_weight = {:?};\n", self.per_weight())
    }

    /// The sum of all weights, which does not depend on `s`.
    fn total(&self) -> f32 {
        let along: f32 = self.first.iter().chain(&self.second).sum();
        along * along
    }

    /// One over the sum of all weights, stretched: see the end of `pcf_square.wgsl`. The sum may come out
    /// too small or too large by 69 halves of an ulp: two weights that are rounded twice, their product, and
    /// 64 sums. 2^-17, half of the stretch, is 128 of them.
    fn per_weight(&self) -> f32 {
        (1.0 + (-16.0_f32).exp2()) / self.total()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_of_weights_is_the_same_between_texels() {
        for weights in [
            Weights::BILINEAR,
            Weights::FOUR_TAPS,
            Weights::WEIGHTED_3,
            Weights::WEIGHTED_5,
            Weights::WEIGHTED_7,
        ] {
            let slope: f32 = weights.first_s.iter().chain(&weights.second_s).sum();
            assert_eq!(slope, 0.0, "{weights:?}");
        }
    }

    #[test]
    fn half_of_the_texels_are_one_half_and_all_of_them_are_all() {
        for weights in [Weights::BILINEAR, Weights::FOUR_TAPS, Weights::WEIGHTED_3] {
            let seen = |shadow: f32| {
                let stretch = 1.0 + (-17.0_f32).exp2();
                (stretch - shadow * weights.per_weight()).clamp(0.0, 1.0)
            };
            assert_eq!(seen(0.5 * weights.total()), 0.5);
            assert_eq!(seen(0.0), 1.0);
            let least = 1.0 - 69.0 * 0.5 * f32::EPSILON;
            assert_eq!(seen(least * weights.total()), 0.0);
        }
    }
}
