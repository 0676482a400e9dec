use super::*;

#[test]
fn spans_that_only_touch_do_not_add_up() {
    let spans = |list: &[[f64; 2]]| list.iter().map(|span| (*span, 1)).collect::<Vec<_>>();
    let deepest = |list: &[[f64; 2]], period| deepest(spans(list).into_iter(), period);
    assert_eq!(deepest(&[], TAU), 0);
    assert_eq!(deepest(&[[0.0, 1.0], [1.0, 2.0]], TAU), 1);
    assert_eq!(deepest(&[[0.0, 1.0], [0.5, 2.0], [0.9, 0.95]], TAU), 3);
    // Over the seam, from either side, and all around.
    assert_eq!(deepest(&[[3.0, 3.5], [-3.0, -2.9]], TAU), 2);
    assert_eq!(deepest(&[[-3.5, -3.0], [3.0, 3.1]], TAU), 2);
    assert_eq!(deepest(&[EVERYWHERE, [0.1, 0.2], [0.3, 0.4]], TAU), 2);
    // Parallel rays have no seam.
    let far = [[3.0, 3.5], [-3.0, -2.9]];
    assert_eq!(deepest(&far, f64::INFINITY), 1);
}
