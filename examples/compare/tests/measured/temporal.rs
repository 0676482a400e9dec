//! Shimmer: what flips while light and camera move a little, and what must not.

use compare::shadow::Shadow;
use compare::stage::Stage;
use compare::technique::Technique;
use compare::temporal::Path;
use host::gpu::Gpu;
use host::scene::{LightKind, Scene, moved_light, spheres};
use shadows::glam::{Vec2, Vec3};
use shadows::reference::{Class, Flips, ReferenceImage};

const SIZE: [u32; 2] = [160, 90];
const STEPS: u32 = 6;

fn row(name: &str) -> Technique {
    let row = compare::table::ROWS
        .iter()
        .find(|row| row.name == name)
        .unwrap();
    row.at(512)
}

/// The stage and the truth on each path.
fn stage(gpu: &Gpu, kind: LightKind) -> (Stage, Vec<Vec<ReferenceImage>>) {
    let mut scene: Scene = spheres();
    scene.shine_as(kind).unwrap();
    let mut stage = Stage::new(gpu, scene, SIZE).unwrap();
    let references = Path::ALL
        .map(|path| compare::temporal::references(gpu, &mut stage, path, STEPS).unwrap())
        .into();
    (stage, references)
}

/// Of all steps together.
fn excess(flips: &[Flips]) -> usize {
    assert_eq!(flips.len(), STEPS as usize);
    assert!(flips.iter().all(|flips| flips.pixels > 1000));
    flips.iter().map(|flips| flips.excess).sum()
}

/// Parts of a pixel by which the picture is moved to see how near an edge of the truth is. GPUs move corners by
/// up to 1/512 to each side; where a volume's side and the receiver are seen at like slopes, their edge moves
/// by some times that.
const PARTS: [u16; 3] = [256, 128, 64];

/// A flip of a technique that the truth has not.
#[derive(Clone, Copy, Debug)]
#[allow(dead_code)] // read where a test prints it
struct Flip {
    path: Path,
    step: usize,
    pixel: [usize; 2],
    /// The part of a pixel that an edge of the truth is away, in one of the two frames; none if by more
    /// than all of them.
    edge: Option<u16>,
}

/// The truth at each place of a path, seen from this far aside in eight directions.
fn around(gpu: &Gpu, stage: &mut Stage, path: Path, pixels: f32) -> Vec<[Vec<Class>; 8]> {
    let (start, exact) = (stage.scene.clone(), stage.reference_scene().unwrap());
    let mut seen_from = |step: u32, direction: usize| -> Vec<Class> {
        let place = path.place(&start, SIZE[1], step, STEPS);
        let aside = Vec2::from_angle(direction as f32 * std::f32::consts::FRAC_PI_4) * pixels;
        let shift = (Vec2::from(place.shift) + aside).into();
        let moved = stage.move_to(gpu, place.camera, place.light, shift);
        moved.unwrap();
        stage.reference_in(&exact).unwrap().classes().collect()
    };
    let all = (0..=STEPS)
        .map(|step| std::array::from_fn(|direction| seen_from(step, direction)))
        .collect();
    let back = stage.move_to(gpu, start.camera, start.light().place, [0.0; 2]);
    back.unwrap();
    all
}

/// Each flip of each technique on each path, one by one.
fn flips_of(gpu: &Gpu, kind: LightKind, names: [&str; 2]) -> [Vec<Flip>; 2] {
    let (mut stage, references) = stage(gpu, kind);
    let mut found = [const { Vec::new() }; 2];
    for (path, references) in Path::ALL.into_iter().zip(&references) {
        let truth: Vec<Vec<Class>> = references
            .iter()
            .map(|image| image.classes().collect())
            .collect();
        let around = PARTS.map(|part| around(gpu, &mut stage, path, 1.0 / f32::from(part)));
        for (name, found) in names.iter().zip(&mut found) {
            let mut shadow = Shadow::new(gpu, &stage.renderer, row(name)).unwrap();
            let mut pictures = Vec::new();
            compare::temporal::watch_with(gpu, &mut stage, path, references, |stage, _| {
                pictures.push(stage.picture(gpu, &mut shadow, &stage.inputs)?.visibility);
                Ok(pictures.last().unwrap().clone())
            })
            .unwrap();
            let (width, moved) = (SIZE[0] as usize, path.moved()[0] as usize);
            for step in 1..truth.len() {
                for pixel in (0..truth[step].len()).filter(|pixel| pixel % width >= moved) {
                    let places = [(step - 1, pixel - moved), (step, pixel)];
                    let [was, now] = places.map(|(step, at)| (truth[step][at], pictures[step][at]));
                    let flips = was.0 == now.0 && (was.1 < 128) != (now.1 < 128);
                    if !flips || !was.0.faces_light() {
                        continue;
                    }
                    let differs = |(step, at): (usize, usize), seen: &Vec<[Vec<Class>; 8]>| {
                        seen[step].iter().any(|seen| seen[at] != was.0)
                    };
                    let mut nearest = PARTS.into_iter().zip(&around);
                    let edge = nearest.find(|(_, seen)| places.iter().any(|&at| differs(at, seen)));
                    found.push(Flip {
                        path,
                        step,
                        pixel: [pixel % width, pixel / width],
                        edge: edge.map(|(part, _)| part),
                    });
                }
            }
        }
    }
    found
}

fn watched(gpu: &Gpu, kind: LightKind, names: &[&str]) -> Vec<[usize; 3]> {
    let (mut stage, references) = stage(gpu, kind);
    let flips = |name: &&str| {
        let mut place = 0;
        Path::ALL.map(|path| {
            let truth = &references[place];
            place += 1;
            excess(&compare::temporal::watch(gpu, &mut stage, &row(name), path, truth).unwrap())
        })
    };
    names.iter().map(flips).collect()
}

/// Volumes know no texels: what is left is what moves an edge through a pixel's centre.
#[test]
fn volumes_flip_where_an_edge_is_within_what_corners_are_moved_by() {
    let Some(gpu) = Gpu::for_test() else { return };
    let [volume, hard] = flips_of(&gpu, LightKind::Point, ["volume", "cube-hard"]);
    eprintln!("{volume:#?}");
    assert!(volume.iter().all(|flip| flip.edge.is_some()), "{volume:#?}");
    // The twin: a map's texels.
    let far = hard.iter().filter(|flip| flip.edge.is_none()).count();
    assert!(far > 100, "{far} of {}", hard.len());
}

#[test]
fn maps_that_stay_in_the_world_do_not_flip_while_the_picture_pans() {
    let Some(gpu) = Gpu::for_test() else { return };
    let found = watched(&gpu, LightKind::Point, &["cube-hard", "cube-disk"]);
    let [hard, disk] = [found[0], found[1]];
    eprintln!("{found:?}");
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
        let flips = compare::temporal::watch_with(gpu, &mut stage, path, truth, |stage, step| {
            let mut inputs = stage.inputs.clone();
            let aside = jitter * inputs.light.xyzw().truncate().length() * (step % 2) as f32;
            inputs.light = moved_light(inputs.light, aside * Vec3::X);
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
    let (camera, light) = (stage.scene.camera, stage.scene.light().place);
    stage.move_to(&gpu, camera, light, [3.0, -2.0]).unwrap();
    let moved = stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
    assert_ne!(moved.visibility, before);
    stage.move_to(&gpu, camera, light, [0.0; 2]).unwrap();
    let back = stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
    assert_eq!(back.visibility, before);
}
