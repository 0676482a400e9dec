//! `compare --hard-cases`: where shadows usually break, every technique, against the reference.

pub mod cases;
mod input;
mod judge;
mod situation;
mod table;

use std::path::Path;

use anyhow::{Context as _, Result};
use indicatif::ProgressBar;
use shadows::glam::{Affine3A, DAffine3, DMat4, Mat4};
use shadows::{Caster, Counter, CubeShadowMapDescriptor, DepthConvention, HomogeneousLight, wgpu};

use self::cases::Case;
pub use self::cases::Expect;
use self::judge::Outcome;
pub use self::judge::{Frame, judge};
use self::situation::Situation;
use self::table::{Row, Table};
use crate::date;
use crate::host::gpu::{Gpu, describe};
use crate::host::image::rgb_png;
use crate::host::random::Random;
use crate::host::scene::Scene;
use crate::output::{self, File};
use crate::progress::progress;
use crate::shadow::Shadow;
use crate::stage::Stage;
use crate::table::ROWS;
use crate::technique::{Config, Technique};

/// Of the pictures, in pixels.
const SIZE: [u32; 2] = [320, 240];
/// Texels along a map's side.
const SIDE: u32 = 512;
/// The named techniques that are tried.
const NAMES: [&str; 13] = [
    "cube-hard",
    "cube-2x2",
    "cube-7x7",
    "cube-disk",
    "cube-textbook",
    "flat-2x2",
    "flat-disk",
    "volume",
    "volume-cpu",
    "volume-vertex",
    "volume-zfail",
    "volume-exact-count",
    TEXTBOOK,
];

const TEXTBOOK: &str = "volume-textbook";

/// Tries every case in so many rounds, writes the table, and says how many should have passed and
/// did not.
///
/// # Errors
/// If the device cannot do what a technique needs, or nothing can be written to `dir`.
pub fn run(gpu: &Gpu, dir: &Path, rounds: u32) -> Result<usize> {
    output::check(dir)?;
    let techniques = techniques()?;
    let cases: Vec<Case> = cases::all().collect();
    let bar = progress(cases.len() as u64 * u64::from(rounds), "hard cases");
    let rows = cases
        .iter()
        .map(|case| row(gpu, case, &techniques, rounds, &bar))
        .collect::<Result<_>>()?;
    bar.finish_and_clear();
    let table = Table {
        driver: describe(&gpu.info),
        date: date::date(date::now()),
        command: "cargo run --release --example compare -- --hard-cases --out docs".into(),
        size: SIZE,
        rounds,
        techniques: techniques.iter().map(|t| t.name.to_string()).collect(),
        rows,
        refusals: input::refusals(gpu)?,
    };
    let (size, sheet) = table.sheet();
    output::write(
        dir,
        vec![
            File::new("hard-cases.md", table.markdown()),
            File::new("hard-cases.png", rgb_png(size, &sheet)?),
            File::new("hard-cases.json", format!("{:#}\n", table.json())),
        ],
    )?;
    let failures = table.failures();
    failures.iter().for_each(|failure| eprintln!("{failure}"));
    println!("{}", dir.join("hard-cases.md").display());
    Ok(failures.len())
}

/// A technique of the table.
fn named(name: &str) -> Result<Technique> {
    let row = ROWS.iter().find(|row| row.name == name);
    let row = row.with_context(|| format!("{name} is no technique"))?;
    Ok(row.at(SIDE))
}

fn techniques() -> Result<Vec<Technique>> {
    let mut all: Vec<Technique> = NAMES.into_iter().map(named).collect::<Result<_>>()?;
    if let Config::Cube { map, sampler } = crate::table::cube(SIDE, Default::default()) {
        let format = wgpu::TextureFormat::Depth16Unorm;
        all.push(Technique {
            name: SIXTEEN_BITS.into(),
            config: Config::Cube {
                map: CubeShadowMapDescriptor { format, ..map },
                sampler,
            },
        });
    }
    Ok(all)
}

const SIXTEEN_BITS: &str = "cube-2x2-16-bit";

fn row(
    gpu: &Gpu,
    case: &Case,
    techniques: &[Technique],
    rounds: u32,
    bar: &ProgressBar,
) -> Result<Row> {
    let mut outcomes: Vec<Option<Outcome>> = vec![None; techniques.len()];
    let mut picture = Vec::new();
    for round in 0..rounds {
        for situation in (case.situations)(&mut Random(u64::from(round))) {
            let what = format!("round {round}, {}", situation.what);
            let shaded = try_all(gpu, case, &situation, &what, techniques, &mut outcomes)
                .with_context(|| format!("{}: {what}", case.name))?;
            if picture.is_empty() {
                picture = shaded;
            }
        }
        bar.inc(1);
    }
    for (technique, outcome) in techniques.iter().zip(&mut outcomes) {
        if let Some(outcome) = outcome {
            outcome.settle(expected(case, technique));
        }
    }
    Ok(Row {
        name: case.name,
        build: case.build,
        answer: case.answer,
        outcomes,
        picture,
    })
}

/// One situation under each technique that applies; as the last of them shows it.
fn try_all(
    gpu: &Gpu,
    case: &Case,
    situation: &Situation,
    what: &str,
    techniques: &[Technique],
    outcomes: &mut [Option<Outcome>],
) -> Result<Vec<[u8; 3]>> {
    let stage = Stage::with_look(gpu, situation.scene.clone(), SIZE, situation.look)?;
    let reference = stage.reference(|_| ())?;
    // Far away it must look as it does here, which is what the reference saw.
    let seen = match situation.offset.length() > 0.0 {
        true => Stage::with_look(gpu, placed(situation, &stage), SIZE, situation.look)?,
        false => stage,
    };
    let mut shaded = Vec::new();
    for (technique, outcome) in techniques.iter().zip(outcomes) {
        let expect = expected(case, technique);
        let light = seen.scene.light_kind();
        if expect == Expect::Nothing
            || !technique.config.applies_to(light)
            || !can_draw(gpu, technique, situation)
        {
            continue;
        }
        let mut shadow = Shadow::new(gpu, &seen.renderer, technique.clone())?;
        let picture = seen.picture(gpu, &mut shadow, &seen.inputs)?;
        let frame = Frame {
            visibility: &picture.visibility,
            interior: shadow.interior(),
            may_wrap: shadow.may_wrap(),
        };
        let found = judge(what, &reference, &frame, expect)?;
        outcome.get_or_insert_default().add(found);
        shaded = picture.shaded;
    }
    Ok(shaded)
}

fn expected(case: &Case, technique: &Technique) -> Expect {
    match &technique.config {
        _ if technique.name == SIXTEEN_BITS => case.sixteen_bits,
        Config::Cube { sampler, .. } if sampler.textbook => match case.maps {
            Expect::Nothing => Expect::Nothing,
            _ => Expect::Reported("the textbook's constant bias is 0.15, whatever the scene"),
        },
        Config::Cube { .. } | Config::Flat { .. } => case.maps,
        Config::Volume(_) if technique.name == TEXTBOOK => {
            case.textbook_volumes.unwrap_or(case.volumes)
        }
        Config::Volume(volume) if volume.counter == Counter::Exact => match case.volumes {
            Expect::Wraps => Expect::Exact,
            other => other,
        },
        Config::Volume(_) => case.volumes,
    }
}

/// Volumes reach to infinity, which a far plane cuts off where the device cannot clamp depth.
fn can_draw(gpu: &Gpu, technique: &Technique, situation: &Situation) -> bool {
    let clamps = wgpu::Features::DEPTH_CLIP_CONTROL;
    situation.look.depth == DepthConvention::InfiniteReverse
        || !matches!(technique.config, Config::Volume(_))
        || gpu.device.features().contains(clamps)
}

/// The scene moved away in f64, as it is seen from its camera.
fn placed(situation: &Situation, stage: &Stage) -> Scene {
    let mut scene = situation.scene.clone();
    // Counted from a point near the camera: no difference is exactly what it was.
    let origin = situation.offset + scene.camera.eye.as_dvec3() * 0.9;
    let away = DAffine3::from_translation(situation.offset);
    let moved =
        |point: shadows::glam::Vec3| (point.as_dvec3() + situation.offset - origin).as_vec3();
    if let Some(caster) = stage.scene_gpu.casters.first() {
        for object in &mut scene.objects {
            let place = away * exact(object.transform);
            let mesh = caster.mesh.clone();
            object.transform = Caster::placed(mesh, place, origin).world_from_object;
        }
    }
    if scene.light.w != 0.0 {
        let position = scene.light.truncate().as_dvec3() + situation.offset;
        scene.light = HomogeneousLight::placed(position, origin).0;
    }
    scene.camera.eye = moved(scene.camera.eye);
    scene.camera.target = moved(scene.camera.target);
    scene
}

fn exact(transform: Affine3A) -> DAffine3 {
    let entries = Mat4::from(transform).to_cols_array().map(f64::from);
    DAffine3::from_mat4(DMat4::from_cols_array(&entries))
}
