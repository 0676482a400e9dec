//! Pictures made a few rows at a time.

use std::ops::Range;

use shadows::HomogeneousLight;
use shadows::error::ReferenceError;
use shadows::glam::Vec3;
use shadows::reference::{Class, Hit, Interior, ReferenceImage, ReferenceObject, ReferenceScene};

use crate::scene::{EYE, SIDE, downward, furnished};

/// Homogeneous: a point.
const LIGHT: HomogeneousLight = HomogeneousLight::point(Vec3::new(0.7, 6.0, -0.4));

fn scene() -> ReferenceScene {
    let meshes = furnished();
    let objects: Vec<ReferenceObject<'_>> = meshes.iter().map(|mesh| mesh.object(true)).collect();
    ReferenceScene::new(&objects).unwrap()
}

fn image(scene: &ReferenceScene, height: u32) -> ReferenceImage {
    let view = downward(EYE, 0.1);
    scene.render(&view, SIDE, height, LIGHT, None).unwrap()
}

fn rows(scene: &ReferenceScene, rows: Range<u32>) -> ReferenceImage {
    image(&scene.clone().with_rows(rows), SIDE)
}

/// Class and surface of every pixel.
fn pixels(image: &ReferenceImage) -> Vec<(Class, Option<Hit>)> {
    let width = image.width();
    let place = |number: usize| [number as u32 % width, number as u32 / width];
    let classes = image.classes().enumerate();
    classes
        .map(|(number, class)| {
            let [x, y] = place(number);
            (class, image.hit(x, y))
        })
        .collect()
}

#[test]
fn rows_put_together_are_the_picture() {
    let scene = scene();
    let whole = image(&scene, SIDE);
    assert!(whole.count(Class::Shadowed) > 100 && whole.count(Class::Lit) > 100);
    let bands = [0..1, 1..50, 50..SIDE - 1, SIDE - 1..SIDE];
    let heights = bands.clone().map(|band| rows(&scene, band).height());
    assert_eq!(heights, [1, 49, SIDE - 51, 1]);
    let together = bands.map(|band| pixels(&rows(&scene, band))).concat();
    assert_eq!(together, pixels(&whole));
    // The twins: a row away, and a smaller picture instead of a part of one.
    let part = pixels(&whole)[(50 * SIDE) as usize..(80 * SIDE) as usize].to_vec();
    assert_eq!(pixels(&rows(&scene, 50..80)), part);
    assert_ne!(pixels(&rows(&scene, 51..81)), part);
    assert_ne!(pixels(&image(&scene, 30)), part);
}

#[test]
fn the_interior_of_rows_is_known_but_for_the_outermost() {
    let scene = scene();
    let whole = image(&scene, SIDE);
    let wrong = |image: &ReferenceImage| -> Vec<u8> {
        let visibility = image.visibility();
        visibility.iter().map(|byte| 255 - byte).collect()
    };
    let verdicts = |image: &ReferenceImage| {
        let error = image.compare(&wrong(image), Interior::Screen).unwrap();
        error.verdicts
    };
    let all = verdicts(&whole);
    let row = |y: u32| (y * SIDE) as usize..((y + 1) * SIDE) as usize;
    let mut outermost = 0;
    for first in (1..SIDE - 10).step_by(10) {
        let band = verdicts(&rows(&scene, first - 1..first + 11));
        for y in 0..10 {
            assert_eq!(band[row(y + 1)], all[row(first + y)], "row {}", first + y);
        }
        // The twin: of the band's own first row too little is known.
        outermost += usize::from(band[row(0)] != all[row(first - 1)]);
    }
    assert!(outermost > 0);
}

#[test]
fn rows_that_are_not_there_are_refused() {
    let scene = scene();
    let view = downward(EYE, 0.1);
    #[expect(clippy::reversed_empty_ranges, reason = "it is what is refused")]
    for rows in [0..9, 8..9, 3..3, 5..2] {
        let refused = scene.clone().with_rows(rows.clone());
        let error = refused.render(&view, 8, 8, LIGHT, None).map(|_| ());
        assert_eq!(error, Err(ReferenceError::Rows { rows, height: 8 }));
    }
    assert!(
        scene
            .with_rows(7..8)
            .render(&view, 8, 8, LIGHT, None)
            .is_ok()
    );
}
