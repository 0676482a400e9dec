//! Shimmer: what flips while light and camera move a little, and what must not.

#[allow(dead_code)]
#[path = "../examples/compare/args.rs"]
mod args;
#[allow(dead_code)]
#[path = "../examples/compare/date.rs"]
mod date;
#[path = "../examples/host/mod.rs"]
mod host;
#[allow(dead_code)]
#[path = "../examples/compare/measure.rs"]
mod measure;
#[allow(dead_code)]
#[path = "../examples/compare/output.rs"]
mod output;
#[allow(dead_code)]
#[path = "../examples/compare/plot.rs"]
mod plot;
#[allow(dead_code)]
#[path = "../examples/compare/progress.rs"]
mod progress;
#[allow(dead_code)]
#[path = "../examples/compare/shadow.rs"]
mod shadow;
#[allow(dead_code)]
#[path = "../examples/compare/soft.rs"]
mod soft;
#[allow(dead_code)]
#[path = "../examples/compare/stage.rs"]
mod stage;
#[allow(dead_code)]
#[path = "../examples/compare/table.rs"]
mod table;
#[allow(dead_code)]
#[path = "../examples/compare/technique.rs"]
mod technique;
#[allow(dead_code)]
#[path = "../examples/compare/temporal/mod.rs"]
mod temporal;

use host::gpu::Gpu;
use host::scene::{LightKind, Scene, spheres};
use shadow::Shadow;
use shadows::HomogeneousLight;
use shadows::glam::{Vec2, Vec4};
use shadows::reference::{Class, Flips, ReferenceImage};
use stage::Stage;
use technique::Technique;
use temporal::Path;

const SIZE: [u32; 2] = [160, 90];
const STEPS: u32 = 6;

fn row(name: &str) -> Technique {
    let row = table::ROWS.iter().find(|row| row.name == name).unwrap();
    row.at(512)
}

/// The stage and the truth on each path.
fn stage(gpu: &Gpu, kind: LightKind) -> (Stage, Vec<Vec<ReferenceImage>>) {
    let mut scene: Scene = spheres();
    scene.shine_as(kind).unwrap();
    let mut stage = Stage::new(gpu, scene, SIZE).unwrap();
    let references = Path::ALL
        .map(|path| temporal::references(gpu, &mut stage, path, STEPS).unwrap())
        .into();
    (stage, references)
}

/// Of all steps together.
fn excess(flips: &[Flips]) -> usize {
    assert_eq!(flips.len(), STEPS as usize);
    assert!(flips.iter().all(|flips| flips.pixels > 1000));
    flips.iter().map(|flips| flips.excess).sum()
}

/// A flip of a technique that the truth has not.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code)] // read where a test prints it
struct Flip {
    path: Path,
    step: usize,
    pixel: [usize; 2],
    /// By how many pixels the picture must move until the truth changes there; none if by more than a
    /// pixel.
    edge: Option<f32>,
}

/// Each flip on each path, one by one.
fn flips_of(gpu: &Gpu, kind: LightKind, name: &str) -> Vec<Flip> {
    let (mut stage, references) = stage(gpu, kind);
    let mut found = Vec::new();
    for (path, truth) in Path::ALL.into_iter().zip(&references) {
        let mut shadow = Shadow::new(gpu, &stage.renderer, row(name)).unwrap();
        let mut pictures = Vec::new();
        temporal::watch_with(gpu, &mut stage, path, truth, |stage, _| {
            pictures.push(stage.picture(gpu, &mut shadow, &stage.inputs)?.visibility);
            Ok(pictures.last().unwrap().clone())
        })
        .unwrap();
        let truth: Vec<Vec<Class>> = truth
            .iter()
            .map(|image| image.classes().collect())
            .collect();
        let (width, moved) = (SIZE[0] as usize, path.moved()[0] as usize);
        for (step, pixel) in (1..truth.len()).flat_map(|s| (0..truth[s].len()).map(move |p| (s, p)))
        {
            if pixel % width < moved {
                continue;
            }
            let places = [(step - 1, pixel - moved), (step, pixel)];
            let [was, now] =
                places.map(|(step, pixel)| (truth[step][pixel], pictures[step][pixel]));
            if was.0 == now.0 && was.0.faces_light() && (was.1 < 128) != (now.1 < 128) {
                let edges = places.map(|(step, at)| edge(gpu, &mut stage, path, step, at, was.0));
                found.push(Flip {
                    path,
                    step,
                    pixel: [pixel % width, pixel / width],
                    edge: edges.into_iter().flatten().reduce(f32::min),
                });
            }
        }
    }
    found
}

/// By how many pixels the picture must move at least until the truth at a pixel is another.
fn edge(
    gpu: &Gpu,
    stage: &mut Stage,
    path: Path,
    step: usize,
    pixel: usize,
    class: Class,
) -> Option<f32> {
    let (start, exact) = (stage.scene.clone(), stage.reference_scene().unwrap());
    let place = path.place(&start, SIZE[1], step as u32, STEPS);
    let around = (0..8).map(|i| Vec2::from_angle(i as f32 * std::f32::consts::FRAC_PI_4));
    let mut distances = [512, 256, 128, 64, 16, 4, 1]
        .map(|part| 1.0 / part as f32)
        .into_iter();
    let found = distances.find(|distance| {
        around.clone().any(|direction| {
            let shift = Vec2::from(place.shift) + direction * *distance;
            stage
                .move_to(gpu, place.camera, place.light, shift.into())
                .unwrap();
            let truth = stage.reference_in(&exact).unwrap();
            truth.classes().nth(pixel) != Some(class)
        })
    });
    stage
        .move_to(gpu, start.camera, start.light, [0.0; 2])
        .unwrap();
    found
}

fn watched(gpu: &Gpu, kind: LightKind, names: &[&str]) -> Vec<[usize; 3]> {
    let (mut stage, references) = stage(gpu, kind);
    let flips = |name: &&str| {
        let mut place = 0;
        Path::ALL.map(|path| {
            let truth = &references[place];
            place += 1;
            excess(&temporal::watch(gpu, &mut stage, &row(name), path, truth).unwrap())
        })
    };
    names.iter().map(flips).collect()
}

#[test]
fn volumes_hardly_flip_and_maps_that_stay_in_the_world_do_not_while_the_picture_pans() {
    let Some(gpu) = Gpu::for_test() else { return };
    let found = watched(
        &gpu,
        LightKind::Point,
        &["volume", "cube-hard", "cube-disk"],
    );
    let [volume, hard, disk] = [found[0], found[1], found[2]];
    eprintln!("{found:?}");
    eprintln!("{:#?}", flips_of(&gpu, LightKind::Point, "volume"));
    // Volumes know no texels: what is left is the last bit of an edge through a pixel's centre.
    assert!(volume.iter().all(|&flips| flips <= 3), "{found:?}");
    // A cube map stands still in the world, so a pan shows the same of it; its texels' edges move
    // with the light, and over the pixels with the camera.
    assert!(hard[2] <= 3, "{found:?}");
    assert!(hard[0] > 20 && hard[1] > 20, "{found:?}");
    // The twin of standing still: a kernel turned from pixel to pixel.
    assert!(disk[2] > 20 + 4 * hard[2], "{found:?}");
}

/// A flat map shown one step of a path, its light turned by a part of a texel to and fro if it is to
/// jitter: what an unsnapped fit does to a map's grid.
fn flat(gpu: &Gpu, jitter: f32) -> [usize; 3] {
    let (mut stage, references) = stage(gpu, LightKind::Directional);
    let mut place = 0;
    Path::ALL.map(|path| {
        let mut shadow = Shadow::new(gpu, &stage.renderer, row("flat-hard")).unwrap();
        let truth = &references[place];
        place += 1;
        let flips = temporal::watch_with(gpu, &mut stage, path, truth, |stage, step| {
            let mut inputs = stage.inputs.clone();
            let aside = jitter * inputs.light.0.truncate().length() * (step % 2) as f32;
            inputs.light = HomogeneousLight(inputs.light.0 + Vec4::new(aside, 0.0, 0.0, 0.0));
            Ok(stage.picture(gpu, &mut shadow, &inputs)?.visibility)
        });
        excess(&flips.unwrap())
    })
}

#[test]
fn a_directional_map_keeps_its_grid_while_the_camera_moves_and_one_that_jitters_is_told() {
    let Some(gpu) = Gpu::for_test() else { return };
    let (snapped, jittered) = (flat(&gpu, 0.0), flat(&gpu, 2.0 / 512.0));
    eprintln!("{snapped:?} {jittered:?}");
    // On the camera's path the texels' edges run over the pixels either way.
    for path in [0, 2] {
        assert!(
            jittered[path] > 2 * snapped[path] + 20,
            "{snapped:?} {jittered:?}"
        );
    }
    // On its grid, the map says the same of a point wherever that is seen.
    assert!(snapped[2] <= 3, "{snapped:?}");
}

#[test]
fn nothing_flips_in_a_picture_that_stands_still() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut stage = Stage::new(&gpu, spheres(), SIZE).unwrap();
    let truth = stage.reference(|_| ()).unwrap();
    let mut shadow = Shadow::new(&gpu, &stage.renderer, row("cube-disk")).unwrap();
    let mut picture = || stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
    let (before, now) = (picture().visibility, picture().visibility);
    let flips = |now: &[u8], moved| truth.flips(now, (&truth, &before), moved).unwrap();
    assert_eq!(flips(&now, [0, 0]).excess, 0);
    // The twin: the same picture, taken for one that moved.
    assert!(flips(&now, [1, 0]).excess > 20);
    // Moving there and back is standing still, too.
    let (camera, light) = (stage.scene.camera, stage.scene.light);
    stage.move_to(&gpu, camera, light, [3.0, -2.0]).unwrap();
    let moved = stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
    assert_ne!(moved.visibility, before);
    stage.move_to(&gpu, camera, light, [0.0; 2]).unwrap();
    let back = stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
    assert_eq!(back.visibility, before);
}
