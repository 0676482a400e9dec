//! How the error falls with texels and samples.

use shadows::reference::bake::{BakedLight, Emitter, LightMap};
use shadows::reference::{Class, ReferenceImage};

use super::yard::{PICTURE, Point, Yard};

/// Mean and root mean square difference at the points.
fn errors(map: &LightMap, points: &[Point], truth: &[f64]) -> [f64; 2] {
    let differences = points
        .iter()
        .zip(truth)
        .map(|(point, truth)| f64::from(map.bilinear(point.at)) - truth);
    let count = points.len() as f64;
    let mean = differences.clone().map(f64::abs).sum::<f64>() / count;
    [
        mean,
        (differences.map(|d| d * d).sum::<f64>() / count).sqrt(),
    ]
}

fn hard(image: &ReferenceImage, points: &[Point]) -> Vec<f64> {
    let classes: Vec<Class> = image.classes().collect();
    let class = |point: &Point| classes[(point.pixel[1] * PICTURE[0] + point.pixel[0]) as usize];
    points
        .iter()
        .map(|point| f64::from(u8::from(class(point) == Class::Lit)))
        .collect()
}

fn soft(image: &ReferenceImage, points: &[Point], radius: f64) -> Vec<f64> {
    let pixels: Vec<[u32; 2]> = points.iter().map(|point| point.pixel).collect();
    let seen = image.area_visibility(&pixels, radius, 512);
    seen.into_iter().map(|seen| seen.unwrap()).collect()
}

const TEXELS: [u32; 4] = [32, 64, 128, 256];
const SAMPLES: [u32; 4] = [1, 4, 16, 64];

/// Prints the table that docs/survey.md shows; `errors[texels][samples]`.
fn table(radius: Option<f32>) -> [[[f64; 2]; 4]; 4] {
    println!("| texels | 1 sample | 4 | 16 | 64 |\n|--:|--:|--:|--:|--:|");
    TEXELS.map(|texels| {
        let yard = Yard::new(texels);
        let image = yard.image();
        let points = yard.points(&image);
        assert!(points.len() > 8000, "{}", points.len());
        let lamp = BakedLight::new(yard.lamp());
        let (lamp, truth) = match radius {
            None => (lamp, hard(&image, &points)),
            Some(radius) => (
                lamp.with_emitter(Emitter::Sphere { radius }),
                soft(&image, &points, radius.into()),
            ),
        };
        let row = SAMPLES.map(|samples| errors(&yard.bake(&lamp, samples), &points, &truth));
        let cells = row.map(|[mean, root]| format!("{mean:.4} / {root:.4}"));
        println!("| {texels} | {} |", cells.join(" | "));
        row
    })
}

/// Of hard edges a texel knows nothing but how much of it is lit: the mean error is that of a band along the edges
/// as wide as texels, its root mean square falls as its root.
#[test]
fn the_error_of_hard_shadows_falls_with_the_size_of_texels() {
    let errors = table(None);
    for (coarse, fine) in errors.iter().zip(&errors[1..]) {
        let ratio = |kind: usize| fine[3][kind] / coarse[3][kind];
        assert!((0.35..0.65).contains(&ratio(0)), "{}", ratio(0));
        assert!((0.55..0.85).contains(&ratio(1)), "{}", ratio(1));
    }
    for row in errors {
        // The twin: one sample a texel is wrong more than many, at any size.
        assert!(row[0][1] > 1.2 * row[3][1], "{row:?}");
        assert!(row[0][1] > row[1][1] && row[1][1] > row[2][1], "{row:?}");
    }
}

/// A penumbra wider than texels is smooth: what remains is noise of the samples.
#[test]
fn the_error_of_soft_shadows_falls_with_samples() {
    let errors = table(Some(0.4));
    for row in &errors {
        for (few, many) in row.iter().zip(&row[1..]) {
            assert!(many[1] < few[1], "{row:?}");
        }
    }
    // Where texels are small enough, four times the samples halve the error, or more.
    let fine = errors[3];
    assert!(
        fine[2][1] < 0.5 * fine[1][1] && fine[1][1] < 0.5 * fine[0][1],
        "{fine:?}"
    );
    // The twin: against a light of another size.
    let yard = Yard::new(128);
    let image = yard.image();
    let points = yard.points(&image);
    let lamp = BakedLight::new(yard.lamp()).with_emitter(Emitter::Sphere { radius: 0.4 });
    let map = yard.bake(&lamp, 16);
    let of = |radius| self::errors(&map, &points, &soft(&image, &points, radius))[1];
    assert!(of(0.2) > 1.5 * of(0.4), "{} {}", of(0.2), of(0.4));
}

/// A texel's mean is better than what its middle says, at any size.
#[test]
fn a_texel_is_filtered_not_its_middle() {
    let yard = Yard::new(64);
    let image = yard.image();
    let points = yard.points(&image);
    let truth = hard(&image, &points);
    let lamp = BakedLight::new(yard.lamp());
    let filtered = errors(&yard.bake(&lamp, 64), &points, &truth)[1];
    // The twin: a map four times as fine whose texels' middles stand for four by four.
    let fine = Yard::new(64 * 8).bake(&lamp, 1);
    let middles = points.iter().zip(&truth).map(|(point, truth)| {
        let texel = point.at.map(|at| (at - 0.5).floor());
        let part = [0, 1].map(|axis| point.at[axis] - 0.5 - texel[axis]);
        let middle = |x: f64, y: f64| {
            let at = [texel[0] + x, texel[1] + y].map(|at| (8.0 * at) + 4.0);
            f64::from(fine.bilinear(at))
        };
        let row = |y| (1.0 - part[0]) * middle(0.0, y) + part[0] * middle(1.0, y);
        (1.0 - part[1]) * row(0.0) + part[1] * row(1.0) - truth
    });
    let middles: Vec<f64> = middles.collect();
    let root = (middles.iter().map(|d| d * d).sum::<f64>() / middles.len() as f64).sqrt();
    assert!(root > 1.1 * filtered, "{root} {filtered}");
}
