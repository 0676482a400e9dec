//! What flips while a camera moves sideways, by three techniques beside each other.

use anyhow::Result;
use compare::animation::animated_png;
use compare::label::{self, band};
use compare::shadow::Shadow;
use compare::sheet::Sheet;
use compare::stage::Stage;
use compare::table;
use compare::temporal::{Path, references, watch_with};
use host::gpu::Gpu;
use host::scene::{Camera, courtyard};
use shadows::glam::vec3;
use shadows::reference::{Class, ReferenceImage};

/// A technique's part of the picture, each of its pixels shown as a square of `ZOOM`, and the gap to the next.
const TILE: [u32; 2] = [156, 104];
const ZOOM: u32 = 2;
const GAP: u32 = 4;
const STEPS: u32 = 32;
const MILLISECONDS: u16 = 90;
/// Texels of a face.
const SIDE: u32 = 512;

/// Techniques, and their words.
const SHOWN: [(&str, &str); 3] = [
    ("cube-textbook", "textbook"),
    ("cube-5x5", "Weighted5"),
    ("volume", "volumes"),
];

/// The camera goes there and back: up to a pixel a frame to the right. A pixel is red where a technique flips from
/// lit to shadow or back although the truth at that pixel does not.
pub fn frames(gpu: &Gpu) -> Result<Vec<u8>> {
    let mut scene = courtyard();
    scene.camera = Camera {
        target: vec3(2.1, 0.1, 5.4),
        fovy: 0.14,
        ..scene.camera
    };
    let mut stage = Stage::new(gpu, scene, TILE)?;
    let references = references(gpu, &mut stage, Path::Camera, STEPS)?;
    let mut shown = Vec::new();
    for (name, words) in SHOWN {
        let mut shadow = Shadow::new(gpu, &stage.renderer, table::named(name, SIDE)?)?;
        let mut steps = Vec::new();
        watch_with(gpu, &mut stage, Path::Camera, &references, |stage, _| {
            let picture = stage.picture(gpu, &mut shadow, &stage.inputs)?;
            steps.push(picture.visibility.clone());
            Ok(picture.visibility)
        })?;
        shown.push((words, steps));
    }
    let there_and_back: Vec<usize> = {
        let last = references.len() - 1;
        (0..last).chain((1..=last).rev()).collect()
    };
    let frames: Vec<_> = (0..there_and_back.len())
        .map(|frame| {
            let now = there_and_back[frame];
            let before = there_and_back[(frame + there_and_back.len() - 1) % there_and_back.len()];
            let tiles = shown.iter().map(|(words, steps)| {
                let at = |step: usize| (&references[step], &steps[step][..]);
                tile(words, at(before), at(now))
            });
            beside(&tiles.collect::<Vec<_>>())
        })
        .collect();
    animated_png(size(), MILLISECONDS, &frames)
}

/// Words and how many pixels flip, then the picture.
fn tile(
    words: &str,
    before: (&ReferenceImage, &[u8]),
    now: (&ReferenceImage, &[u8]),
) -> Vec<[u8; 3]> {
    let lit = |value: u8| value >= 128;
    let exact = now.0.visibility();
    let classes = before.0.classes().zip(now.0.classes());
    let values = before.1.iter().zip(now.1).zip(&exact);
    let mut count = 0;
    let pixels: Vec<[u8; 3]> = classes
        .zip(values)
        .map(|((was, is), ((&before, &now), &exact))| {
            if is.faces_light() && was == is && lit(before) != lit(now) {
                count += 1;
                return [230, 40, 30];
            }
            // What faces away from the light is dark whatever a map says.
            let away = !matches!(is, Class::Lit | Class::Shadowed);
            let value = u32::from(if away { exact } else { now });
            [(40 + value * 200 / 255) as u8; 3]
        })
        .collect();
    let words = format!("{words}: {count}");
    [band(ZOOM * TILE[0], &words), zoomed(&pixels)].concat()
}

fn zoomed(pixels: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let rows = pixels.chunks_exact(TILE[0] as usize);
    let wide = rows.map(|row| row.iter().flat_map(|pixel| [*pixel; ZOOM as usize]));
    wide.flat_map(|row| row.collect::<Vec<_>>().repeat(ZOOM as usize))
        .collect()
}

fn size() -> [u32; 2] {
    let tiles = SHOWN.len() as u32;
    let [across, down] = TILE.map(|side| ZOOM * side);
    [tiles * (across + GAP) - GAP, down + label::ROWS]
}

fn beside(tiles: &[Vec<[u8; 3]>]) -> Vec<[u8; 3]> {
    let across = ZOOM * TILE[0];
    let mut sheet = Sheet::new(size());
    for (place, tile) in (0..).zip(tiles) {
        sheet.put(tile, across, [place * (across + GAP), 0]);
    }
    sheet.pixels
}
