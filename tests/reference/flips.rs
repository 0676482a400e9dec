//! Flips against counts made by hand.

use shadows::HomogeneousLight;
use shadows::error::ReferenceError;
use shadows::glam::{Vec2, Vec3};
use shadows::reference::{Flips, ReferenceImage, ReferenceScene};

use crate::scene::{EYE, SIDE, downward, ground, rectangle};

/// A square's shadow under a light that is so far aside, seen in a picture of so many pixels.
fn shadow(aside: f32, side: u32) -> ReferenceImage {
    let (ground, roof) = (ground(), rectangle(Vec2::NEG_ONE, Vec2::ONE, 2.0));
    let scene = ReferenceScene::new(&[ground.object(false), roof.object(true)]).unwrap();
    let light = HomogeneousLight::point(Vec3::new(aside, 4.0, 0.0));
    scene
        .render(&downward(EYE, 7.5), side, side, light, None)
        .unwrap()
}

fn flips(now: (&ReferenceImage, &[u8]), before: (&ReferenceImage, &[u8])) -> Flips {
    now.0.flips(now.1, before, [0, 0]).unwrap()
}

#[test]
fn the_truth_flips_nothing_however_the_light_moves() {
    let (before, now) = (shadow(0.0, SIDE), shadow(0.3, SIDE));
    let truth = [before.visibility(), now.visibility()];
    let found = flips((&now, &truth[1]), (&before, &truth[0]));
    assert!(found.of_reference > 100, "{found:?}");
    assert_eq!((found.excess, found.jumps), (0, 0));
    // What flips in excess is what differs from the truth in one of the two.
    let stuck = flips((&now, &truth[0]), (&before, &truth[0]));
    assert_eq!((stuck.excess, stuck.of_reference), (0, found.of_reference));
    let late = flips((&now, &truth[1]), (&now, &truth[0]));
    assert_eq!((late.excess, late.of_reference), (found.of_reference, 0));
}

#[test]
fn each_pixel_that_changes_without_reason_counts_once() {
    let image = shadow(0.0, SIDE);
    let truth = image.visibility();
    let still = flips((&image, &truth), (&image, &truth));
    assert_eq!((still.excess, still.pixels), (0, image.lit_facing()));
    let mut shown = truth.clone();
    for (pixel, byte) in [(0, 0), (5, 100), (7, 130)] {
        assert_eq!(shown[pixel], 255);
        shown[pixel] = byte;
    }
    // 130 is still lit; 100 is in shadow, and half of full light away; 0 too.
    let changed = flips((&image, &shown), (&image, &truth));
    assert_eq!((changed.excess, changed.jumps), (2, 2));
    let mut soft = truth;
    (shown[5], soft[5]) = (120, 140);
    (shown[0], soft[0]) = (0, 0);
    let little = flips((&image, &shown), (&image, &soft));
    assert_eq!((little.excess, little.jumps), (1, 0));
}

#[test]
fn a_picture_that_moves_is_compared_where_it_was() {
    let image = shadow(0.0, SIDE);
    let side = SIDE as usize;
    let truth = image.visibility();
    // Wrong in one pixel, which moves with the picture.
    let wrong_at = |x: usize| {
        let mut shown = truth.clone();
        shown[3 * side + x] ^= 255;
        shown
    };
    let (before, now) = (wrong_at(4), wrong_at(5));
    let moved = |by| image.flips(&now, (&image, &before), by).unwrap();
    assert_eq!(moved([0, 0]).excess, 2);
    let right = moved([1, 0]);
    // Only the shadow's edges, which did not move here, are another truth.
    assert_eq!(right.excess, 0);
    assert_eq!(right.pixels, image.lit_facing() - side);
    assert!(right.of_reference > 0);
    assert_eq!(moved([-1, 0]).excess, 2);
    assert_eq!(moved([SIDE as i32, 0]), Flips::default());
}

#[test]
fn pictures_that_do_not_fit_are_refused() {
    let (image, small) = (shadow(0.0, SIDE), shadow(0.0, 8));
    let truth = [image.visibility(), small.visibility()];
    let sizes = image.flips(&truth[0], (&small, &truth[1]), [0, 0]);
    let (before, now) = ([8, 8], [SIDE, SIDE]);
    assert_eq!(sizes, Err(ReferenceError::OtherSize { before, now }));
    let (passed, pixels) = (64, truth[0].len());
    let count = Err(ReferenceError::VisibilityCount { passed, pixels });
    assert_eq!(image.flips(&truth[1], (&image, &truth[0]), [0, 0]), count);
    assert_eq!(image.flips(&truth[0], (&image, &truth[1]), [0, 0]), count);
    let broken = vec![f32::NAN; pixels];
    let fine = vec![1.0; pixels];
    let told = image.flips(&broken, (&image, &fine), [0, 0]);
    assert!(matches!(told, Err(ReferenceError::Visibility { .. })));
    assert_eq!(
        image.flips(&fine, (&image, &fine), [0, 0]).unwrap().excess,
        0
    );
}
