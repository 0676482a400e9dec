//! The hard cases of `compare`: one round of them passes, and none of them can pass by default.
#![allow(dead_code)] // parts of the example

#[path = "../examples/compare/args.rs"]
mod args;
#[path = "../examples/compare/date.rs"]
mod date;
#[path = "../examples/compare/hard/mod.rs"]
mod hard;
#[path = "../examples/host/mod.rs"]
mod host;
#[path = "../examples/compare/measure.rs"]
mod measure;
#[path = "../examples/compare/output.rs"]
mod output;
#[path = "../examples/compare/progress.rs"]
mod progress;
#[path = "../examples/compare/shadow.rs"]
mod shadow;
#[path = "../examples/compare/stage.rs"]
mod stage;
#[path = "../examples/compare/table.rs"]
mod table;
#[path = "../examples/compare/technique.rs"]
mod technique;

use std::path::Path;

use shadows::reference::{Class, Interior};

use crate::hard::{Expect, Frame, cases, judge};
use crate::host::gpu::Gpu;
use crate::host::random::Random;
use crate::stage::Stage;

const SIZE: [u32; 2] = [160, 120];

#[test]
fn one_round_passes() {
    let Some(gpu) = Gpu::for_test() else { return };
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hard_cases");
    assert_eq!(hard::run(&gpu, &dir, 1).unwrap(), 0);
    let table = std::fs::read_to_string(dir.join("hard-cases.md")).unwrap();
    for case in cases::all() {
        let row = table.lines().find(|line| line.contains(case.name)).unwrap();
        assert!(row.matches("| 0").count() > 2, "{row}");
    }
}

/// Without shadows, and with nothing but shadow, no case is passed: each has both in its interior.
#[test]
fn no_case_passes_without_shadows_or_without_light() {
    let Some(gpu) = Gpu::for_test() else { return };
    for case in cases::all() {
        let mut failures = [0, 0];
        for situation in (case.situations)(&mut Random(0)) {
            let stage = Stage::with_look(&gpu, situation.scene, SIZE, situation.look).unwrap();
            let reference = stage.reference(|_| ()).unwrap();
            for (light, failures) in [255, 0].into_iter().zip(&mut failures) {
                let drawn = |class| if class == Class::Background { 0 } else { light };
                let visibility: Vec<u8> = reference.classes().map(drawn).collect();
                let frame = Frame {
                    visibility: &visibility,
                    interior: Interior::Screen,
                    may_wrap: true,
                };
                let found = judge("", &reference, &frame, Expect::Exact).unwrap();
                *failures += found.failures.len();
            }
        }
        assert!(
            failures.iter().all(|&count| count > 0),
            "{}: {failures:?}",
            case.name
        );
    }
}

#[test]
fn light_where_nothing_is_drawn_is_wrong() {
    let Some(gpu) = Gpu::for_test() else { return };
    let case = cases::all()
        .find(|case| case.name.starts_with("Nothing"))
        .unwrap();
    let scene = (case.situations)(&mut Random(0)).remove(0).scene;
    let reference = Stage::new(&gpu, scene, SIZE)
        .unwrap()
        .reference(|_| ())
        .unwrap();
    let wrong = |background| {
        let truth = reference.classes().zip(reference.visibility());
        let visibility: Vec<u8> = truth
            .map(|(class, right)| {
                if class == Class::Background {
                    background
                } else {
                    right
                }
            })
            .collect();
        let frame = Frame {
            visibility: &visibility,
            interior: Interior::Screen,
            may_wrap: false,
        };
        judge("", &reference, &frame, Expect::Exact)
            .unwrap()
            .interior
    };
    assert_eq!(wrong(0), 0);
    assert!(wrong(255) > 1000);
}
