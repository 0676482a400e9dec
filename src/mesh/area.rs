//! Whether a triangle has no area at all, exactly.

/// Twice this bound covers the rounding of a 2 x 2 determinant of differences
/// (Shewchuk 1997 gives 1.5 `f64::EPSILON` and a little).
const FILTER: f64 = 2.0 * f64::EPSILON;

/// Whether three points lie on one line (or in one point), without rounding.
pub(super) fn is_zero(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> bool {
    // On one line in space means on one line in all three coordinate planes.
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(x, y)| on_one_line([a[x], a[y]], [b[x], b[y]], [c[x], c[y]]))
}

fn on_one_line(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> bool {
    let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(|point| point.map(f64::from));
    let left = (bx - ax) * (cy - ay);
    let right = (by - ay) * (cx - ax);
    let scale = left.abs() + right.abs();
    if (left - right).abs() > FILTER * scale {
        return false;
    }
    // A product of f32 differences cannot underflow in f64: zero here is zero.
    if scale == 0.0 {
        return true;
    }
    sums_to_zero([ax * by, -ay * bx, bx * cy, -by * cx, cx * ay, -cy * ax])
}

/// Whether six products of two f32 (each exact in f64) sum to zero: the expansion sum of
/// Shewchuk (1997), whose parts do not overlap and so cancel only if all are zero.
fn sums_to_zero(terms: [f64; 6]) -> bool {
    let mut parts = [0.0; 6];
    for (count, term) in terms.into_iter().enumerate() {
        let mut sum = term;
        for part in &mut parts[..count] {
            (sum, *part) = two_sum(sum, *part);
        }
        parts[count] = sum;
    }
    parts == [0.0; 6]
}

/// The rounded sum and its exact error (Knuth 1969).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_ulp_off_the_line_is_not_on_it() {
        // Multiples of a short vector are exact, at any scale and far from equal magnitudes.
        for scale in [1e-30f32, 1.0, 1e30] {
            let at = |t: f32| [3.0 * t * scale, -5.0 * t * scale, 7.0 * t * scale];
            let (a, b, c) = (at(1.0), at(1024.0), at(-3.0 * 65536.0));
            let exact = 3.0 * 1024.0 * scale == b[0] && (b[0] / a[0]) == (b[2] / a[2]);
            assert!(exact);
            let off = [c[0], f32::from_bits(c[1].to_bits() + 1), c[2]];
            if scale == 1.0 {
                assert!(is_zero(a, b, c));
            }
            assert!(!is_zero(a, b, off));
        }
    }

    #[test]
    fn what_cancels_in_f64_is_still_seen() {
        // The differences need more than 53 bits, so that rounded they lie on a line.
        let (a, b) = ([1.0, 1.0, 0.0], [0.0, 0.0, 0.0]);
        let off = [-1e-30, -1.1e-30, 0.0];
        let [[ax, ay, _], [bx, by, _], [cx, cy, _]] = [b, a, off].map(|p| p.map(f64::from));
        let rounded = (ax - bx) * (cy - by) - (ay - by) * (cx - bx);
        assert_eq!(rounded, 0.0);
        assert!(!is_zero(b, a, off));
        assert!(is_zero(b, a, [-1e-30, -1e-30, 0.0]));
    }
}
