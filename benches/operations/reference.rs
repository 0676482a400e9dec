//! The exact answer at 160 x 90, and comparing with it. All cores are used; nothing here is for
//! frames.

use anyhow::Result;
use shadows::reference::{
    Candidate, Interior, ReferenceImage, ReferenceObject, ReferenceScene, Survey,
};

use crate::clock::Bench;
use crate::stage::Stage;

const WIDTH: u32 = 160;
const HEIGHT: u32 = 90;

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let objects: Vec<_> = stage
        .scene
        .objects
        .iter()
        .map(|object| {
            let mesh = &stage.scene.meshes[object.mesh];
            ReferenceObject {
                positions: &mesh.positions,
                indices: &mesh.indices,
                transform: object.transform.as_daffine3(),
                casts: object.casts,
            }
        })
        .collect();
    bench.plain("reference/ReferenceScene::new", || {
        ReferenceScene::new(&objects)
    });
    let scene = ReferenceScene::new(&objects)?;
    let range = Some(stage.scene.light().range);
    let render = || scene.render(&stage.view, WIDTH, HEIGHT, stage.light(), range);
    bench.plain("reference/render", render);
    bench.plain("reference/render_spot", || {
        scene.render_spot(&stage.view, WIDTH, HEIGHT, &stage.spot())
    });
    images(bench, &render()?);
    survey(bench);
    Ok(())
}

fn images(bench: &mut Bench<'_>, image: &ReferenceImage) {
    // The answer moved by three pixels: wrong at every edge, as techniques are.
    let mut moved = image.visibility();
    moved.rotate_right(3);
    bench.plain("reference/compare", || {
        image.compare(&moved, Interior::Screen)
    });
    let before = image.visibility();
    bench.plain("reference/flips", || {
        image.flips(&moved, (image, &before), [0, 0])
    });
    let map = Interior::Map {
        face_size: 1024,
        kernel_radius: 1.0,
    };
    bench.plain("reference/interior_pixels", || image.interior_pixels(map));
    let column = |y| [WIDTH / 2, y];
    let pixels: Vec<_> = (0..HEIGHT).map(column).collect();
    bench.plain("reference/area_visibility, 64 samples", || {
        image.area_visibility(&pixels, 0.1, 64)
    });
    bench.plain("reference/visibility", || image.visibility());
    bench.plain("reference/coverage", || image.coverage());
}

fn survey(bench: &mut Bench<'_>) {
    let candidate = |i: u32| Candidate {
        configuration: i,
        time: f64::from(i * 7919 % 1000),
        error: f64::from(i * 104_729 % 1000),
    };
    let survey = Survey::new((0..1000).map(candidate).collect());
    bench.plain("reference/Survey::front, 1,000", || survey.front().len());
    bench.plain("reference/Survey::cheapest, 1,000", || {
        survey.cheapest(10.0).map(|found| found.configuration)
    });
    bench.plain("reference/Survey::most_exact, 1,000", || {
        survey.most_exact(10.0).map(|found| found.configuration)
    });
}
