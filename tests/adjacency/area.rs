//! Triangles without area, against integers of 128 bits.

use proptest::prelude::*;
use shadows::mesh::Adjacency;

/// What the report says of one triangle.
fn zero_area(corners: [[f32; 3]; 3]) -> bool {
    let adjacency = Adjacency::new(&corners, &[0, 1, 2]).unwrap();
    assert_eq!(adjacency.triangles().len(), 1, "collapsed");
    adjacency.topology().zero_area_triangles == 1
}

/// The same by integers: the coordinates are whole and below 2^62.
fn by_integers(corners: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.map(|x| x as i128));
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(x, y)| (b[x] - a[x]) * (c[y] - a[y]) == (b[y] - a[y]) * (c[x] - a[x]))
}

/// The next number away from zero that is whole.
fn nudged(x: f32) -> f32 {
    let next = f32::from_bits(x.to_bits() + 1);
    if next.fract() == 0.0 {
        next
    } else {
        x + x.signum()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn only_what_lies_exactly_on_a_line_has_no_area(
        direction in prop::array::uniform3(1i32..4096),
        steps in prop::array::uniform3((1i32..4096, 0u32..38)),
        negative: bool,
        corner in 0usize..3,
        axis in 0usize..3,
        exponent in -80i32..40,
    ) {
        // Points on a line through the origin; a step times the direction has 24 bits, and
        // differences between them have more than the 53 of f64.
        let mut corners = steps.map(|(step, shift)| {
            direction.map(|d| (d * step) as f32 * (1u64 << shift) as f32)
        });
        if negative {
            corners[0] = corners[0].map(|x| -x);
        }
        prop_assume!(corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]);
        prop_assert!(by_integers(corners));
        prop_assert!(zero_area(corners));

        // The broken twin: one coordinate off by one ulp (or by one), at any scale.
        corners[corner][axis] = nudged(corners[corner][axis]);
        prop_assert!(!by_integers(corners));
        prop_assert!(!zero_area(corners));
        let scaled = corners.map(|p| p.map(|x| x * 2f32.powi(exponent)));
        prop_assert!(!zero_area(scaled));
    }
}

#[test]
fn a_line_whose_products_cancel_over_sixty_bits_is_a_line() {
    // (c - a) / (b - a) = (2^60 - 1) / (2^45 - 1) on both axes; summed in f64, the products of the
    // coordinates leave a rest of -2^30.
    let two = |exponent: i32| 2f32.powi(exponent);
    let line = [
        [1.0, -1.0 - two(15), 0.0],
        [two(45), two(30), 0.0],
        [two(60), two(30) + two(45), 0.0],
    ];
    assert!(by_integers(line));
    for order in [[0, 1, 2], [1, 2, 0], [2, 1, 0]] {
        assert!(zero_area(order.map(|corner| line[corner])));
        for axis in 0..2 {
            let mut off = line;
            off[0][axis] = nudged(off[0][axis]);
            assert!(!by_integers(off));
            assert!(!zero_area(order.map(|corner| off[corner])));
        }
    }
}
