//! Loops and words in the pages' pictures.

use compare::animation::animated_png;
use compare::label::{ROWS, band};

type Frame = Vec<[u8; 3]>;

const SIZE: [u32; 2] = [24, 16];

/// A part of each frame's pixels is other than before.
fn few_colors() -> Vec<Frame> {
    let color = |pixel: u32, frame: u32| match (pixel + 7 * frame) % SIZE[0] < 9 {
        true => [250, 15 * (pixel / SIZE[0]) as u8, 0],
        false => [0, 60, 180],
    };
    let frame = |frame| (0..SIZE[0] * SIZE[1]).map(move |pixel| color(pixel, frame));
    (0..5).map(|number| frame(number).collect()).collect()
}

/// The frames as a browser shows them, or as one that draws what is unchanged as black.
fn played(file: &[u8], forgetful: bool) -> Vec<Frame> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let animation = *reader.info().animation_control().expect("it moves");
    assert_eq!(animation.num_plays, 0, "for ever");
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let mut shown = vec![[0; 3]; bytes.len() / 4];
    let frames = (0..animation.num_frames).map(|_| {
        reader.next_frame(&mut bytes).unwrap();
        for (pixel, now) in shown.iter_mut().zip(bytes.chunks_exact(4)) {
            match (now[3], forgetful) {
                (0, false) => {}
                (0, true) => *pixel = [0; 3],
                _ => *pixel = [now[0], now[1], now[2]],
            }
        }
        shown.clone()
    });
    frames.collect()
}

#[test]
fn a_loop_of_few_colors_comes_back_as_it_was() {
    let frames = few_colors();
    let file = animated_png(SIZE, 80, &frames).unwrap();
    assert_eq!(played(&file, false), frames);
    // The twin: what did not change is left out, so that it must be kept.
    assert_ne!(played(&file, true), frames);
}

#[test]
fn a_loop_of_many_colors_has_ones_near_them() {
    let side = 64;
    let ramp = |x: u32, y: u32| [4 * x, 4 * y, 2 * (x + y)].map(|channel| channel as u8);
    let pixels = (0..side * side).map(|pixel| ramp(pixel % side, pixel / side));
    let frame: Frame = pixels.collect();
    let file = animated_png([side; 2], 80, std::slice::from_ref(&frame)).unwrap();
    let [shown] = &played(&file, false)[..] else {
        panic!("one frame");
    };
    let farthest = |other: &Frame| {
        let channels = frame.as_flattened().iter().zip(other.as_flattened());
        channels.map(|(a, b)| a.abs_diff(*b)).max()
    };
    // A sixteenth of each of the two ramps has a colour of its own.
    assert!(farthest(shown) <= Some(16), "{:?}", farthest(shown));
    let mut mirrored = shown.clone();
    mirrored.reverse();
    assert!(farthest(&mirrored) > Some(16));
}

#[test]
fn frames_of_another_size_are_refused() {
    let error = animated_png([25, 16], 80, &few_colors()).unwrap_err();
    assert!(error.to_string().contains("25 x 16"), "{error}");
    assert!(animated_png(SIZE, 80, &[]).is_err());
}

#[test]
fn words_are_told_apart() {
    let dark = |words: &str| band(200, words).iter().filter(|p| **p != [255; 3]).count();
    assert_eq!(band(200, "Vogel").len(), 200 * ROWS as usize);
    // Ten dots of four pixels each.
    assert_eq!(dark("l"), 4 * 10);
    assert_eq!(dark("ll"), 8 * 10);
    assert_ne!(band(200, "Weighted3"), band(200, "Weighted5"));
    // What the font lacks is blank, and what does not fit is cut off.
    assert_eq!(dark("\u{e9}"), 0);
    assert_eq!(dark(&"l".repeat(40)), dark(&"l".repeat(17)));
}
