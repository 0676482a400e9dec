//! The hard cases of `compare`: one round of them passes, and none of them can pass by default.

use shadows::reference::{Class, Interior, ReferenceImage};

use compare::hard::atlas::{Frames, play};
use compare::hard::cases::{self, Case, Course, mesh};
use compare::hard::causes;
use compare::hard::expect::{Expect, expected, is_software};
use compare::hard::input::t_junction;
use compare::hard::judge::{Frame, judge};
use compare::hard::limits::{self, Limit};
use compare::hard::outcome::Outcome;
use compare::hard::seams::{self, Rates};
use compare::hard::situation::Situation;
use compare::hard::small::lit_where_nothing_casts;
use compare::hard::table::Row;
use compare::hard::{techniques, trial};
use compare::shadow::Shadow;
use compare::stage::Stage;
use compare::technique::{Config, Technique};
use host::gpu::Gpu;
use host::random::Random;
use host::scene::LightKind;

const SIZE: [u32; 2] = [80, 60];

/// Positions, or the depths of the host's own buffer, are rounded there by more than any technique may be
/// off: few pixels are wrong, but for each technique some.
const NOWHERE_EXACT: [&str; 2] = ["Far from the origin, plain f32", "24-bit depth-stencil"];

#[test]
fn one_round_passes() {
    let Some(gpu) = Gpu::for_test() else { return };
    let dir = std::env::temp_dir().join(format!("shadows-hard-cases-{}", std::process::id()));
    assert_eq!(
        compare::hard::run(&gpu, &cases::chosen(&[]).unwrap(), &dir, 1).unwrap(),
        0
    );
    let table = std::fs::read_to_string(dir.join("hard-cases.md")).unwrap();
    for case in cases::all() {
        let row = table.lines().find(|line| line.contains(case.name)).unwrap();
        let cells = row.split('|').map(str::trim);
        if NOWHERE_EXACT.contains(&case.name) {
            let shares = cells.filter_map(|cell| cell.strip_suffix(" %")?.parse::<f64>().ok());
            assert!(
                shares.clone().count() > 5 && shares.fold(0.0, f64::max) < 0.4,
                "{row}"
            );
        } else {
            assert!(cells.filter(|cell| *cell == "0").count() > 2, "{row}");
        }
    }
    let asked = format!("--hard-cases --rounds 1 --out {}`", dir.display());
    assert!(table.contains(&asked), "{asked}");
    std::fs::remove_dir_all(&dir).unwrap();
}

/// Limits that are as wrong as no shadow at all: a bias of 0.15 is more than the scene at x 1e-4, and a projector has no
/// picture of what is around its light; in the courtyard planar shadows are as many as are left out.
const ALL_IS_LOST: [(&str, &str); 3] = [
    ("Scale", "cube-textbook"),
    ("Light inside a closed caster", "projected"),
    ("Courtyard from anywhere", "planar"),
];

/// Without shadows, and with nothing but shadow, no technique passes any case by what is expected
/// of it there, known limits included.
#[test]
fn no_case_passes_without_shadows_or_without_light() {
    let Some(gpu) = Gpu::for_test() else { return };
    let techniques = techniques().unwrap();
    let mut passed = Vec::new();
    for case in cases::all() {
        for (technique, [lit, dark]) in twins(&gpu, &case, &techniques) {
            for (twin, outcome) in [("lit", lit), ("dark", dark)] {
                let lost = twin == "lit" && ALL_IS_LOST.contains(&(case.name, technique));
                if outcome.failures.is_empty() != lost {
                    passed.push(format!(
                        "{}, {technique}, all {twin}: {outcome:?}",
                        case.name
                    ));
                }
            }
        }
    }
    assert!(passed.is_empty(), "{passed:#?}");
}

/// For each thing that is expected of some technique, what the two broken ones come to.
fn twins<'a>(gpu: &Gpu, case: &Case, techniques: &'a [Technique]) -> Vec<(&'a str, [Outcome; 2])> {
    let expects = |technique: &Technique| expected(case, technique, is_software(gpu));
    let mut tried: Vec<(&Technique, [Outcome; 2])> = Vec::new();
    for technique in techniques {
        let same = |(other, _): &(&Technique, _)| {
            expects(other) == expects(technique) && kind(other) == kind(technique)
        };
        if expects(technique) != Expect::Nothing && !tried.iter().any(same) {
            tried.push((technique, Default::default()));
        }
    }
    for situation in (case.situations)(&mut Random(0)) {
        let scene = situation.scene.clone();
        let stage = Stage::with_look(gpu, scene, SIZE, situation.look).unwrap();
        let reference = stage.reference(|_| ()).unwrap();
        for (technique, outcomes) in &mut tried {
            if trial::applies(gpu, technique, &situation) {
                let expect = expects(technique).where_it(situation.wraps);
                let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone()).unwrap();
                shadow.prepare(gpu, &stage.inputs).unwrap();
                for (light, outcome) in [255, 0].into_iter().zip(outcomes) {
                    let visibility = drawn(&reference, light);
                    let frame = situation.frame(technique, &mut shadow, &visibility);
                    outcome.add(judge("", &reference, &frame, expect).unwrap());
                }
            }
        }
    }
    let frames = case.frames.map(|frames| frames(&mut Random(0)));
    for frames in frames.unwrap_or_default() {
        let frames = Frames {
            size: SIZE,
            ..frames
        };
        let truth = frames.truth().unwrap();
        for (technique, outcomes) in &mut tried {
            for shown in play(gpu, &frames, technique, |module| module).unwrap() {
                let [frame, view, light] = shown.at;
                for (all, outcome) in [255, 0].into_iter().zip(&mut *outcomes) {
                    let visibility = drawn(&truth[frame][view][light], all);
                    let found = shown.judge("", &truth, &visibility, expects(technique));
                    outcome.add(found.unwrap());
                }
            }
        }
    }
    tried.retain(|(_, [outcome, _])| outcome.situations > 0);
    for (technique, outcomes) in &mut tried {
        for outcome in outcomes {
            outcome.end_round("", expects(technique));
            outcome.end(expects(technique));
        }
    }
    let named = tried.into_iter();
    named
        .map(|(technique, outcomes)| (technique.name.as_ref(), outcomes))
        .collect()
}

fn kind(technique: &Technique) -> u32 {
    match technique.config {
        Config::Cube { .. } => 0,
        Config::Flat { .. } => 1,
        Config::Volume(_) => 2,
        Config::Peer { .. } => 3,
        Config::Atlas { .. } => 4,
        Config::Survey(_) => 5,
    }
}

/// The same light wherever there is something in range.
fn drawn(reference: &ReferenceImage, light: u8) -> Vec<u8> {
    let shown = |class| match class {
        Class::Background | Class::OutOfRange => 0,
        _ => light,
    };
    reference.classes().map(shown).collect()
}

fn case(start: &str) -> Case {
    let found = cases::all().find(|case| case.name.starts_with(start));
    found.unwrap()
}

fn seen(gpu: &Gpu, situation: &Situation) -> ReferenceImage {
    let stage = Stage::new(gpu, situation.scene.clone(), SIZE).unwrap();
    stage.reference(|_| ()).unwrap()
}

/// Interior errors of a picture in which one class has this visibility and the others the true one.
fn wrong(
    reference: &ReferenceImage,
    changed: Class,
    visibility: u8,
    reach: Option<(shadows::glam::DVec3, f32)>,
) -> usize {
    let truth = reference.classes().zip(reference.visibility());
    let shown = |(class, right)| if class == changed { visibility } else { right };
    let frame = Frame {
        visibility: &truth.map(shown).collect::<Vec<u8>>(),
        interior: Interior::Screen,
        may_wrap: false,
        reach,
    };
    let found = judge("", reference, &frame, Expect::Exact).unwrap();
    found.interior()
}

#[test]
fn light_where_nothing_is_drawn_is_wrong() {
    let Some(gpu) = Gpu::for_test() else { return };
    let situation = (case("Nothing").situations)(&mut Random(0)).remove(0);
    let reference = seen(&gpu, &situation);
    assert_eq!(wrong(&reference, Class::Background, 0, None), 0);
    assert!(wrong(&reference, Class::Background, 255, None) > 1000);
}

#[test]
fn light_beyond_the_range_is_wrong_also_by_one_ulp() {
    let Some(gpu) = Gpu::for_test() else { return };
    let techniques = techniques().unwrap();
    let mut lit = Vec::new();
    for situation in (case("Beyond").situations)(&mut Random(0)) {
        let reference = seen(&gpu, &situation);
        let reach = situation.reach(&techniques[0]);
        assert_eq!(wrong(&reference, Class::OutOfRange, 0, reach), 0);
        let count = wrong(&reference, Class::OutOfRange, 255, reach);
        lit.push((situation.what.clone(), count, reference.count(Class::Lit)));
    }
    let of = |what: &str| lit.iter().find(|(name, ..)| name.contains(what)).unwrap();
    assert!(of("range 6.5").1 > 500, "{lit:?}");
    assert!(of("-1 ulp").1 > 500 && of("-1 ulp").2 == 0, "{lit:?}");
    assert!(of("+1 ulp").1 == 0 && of("+1 ulp").2 > 500, "{lit:?}");
}

/// 1000 pixels of which so many are wrong: lit, in shadow, all.
fn round(counts: [usize; 3], expect: Expect) -> Outcome {
    let [false_lit, false_shadow, wrong] = counts;
    let mut outcome = Outcome {
        counted: 1000,
        false_lit,
        false_shadow,
        wrong,
        ..Outcome::default()
    };
    outcome.end_round("", expect);
    outcome.end(expect);
    outcome
}

#[test]
fn a_known_limit_holds_up_to_its_bound_and_fails_above_it() {
    let expect = Expect::Limit(Limit {
        why: "it is",
        at_most: [1.0, 0.2, 5.0],
    });
    assert_eq!(round([10, 2, 50], expect).failures.len(), 0);
    for counts in [[11, 2, 50], [10, 3, 50], [10, 2, 51]] {
        assert_eq!(round(counts, expect).failures.len(), 1, "{counts:?}");
    }
    let mut all = round([0, 0, 0], expect);
    all.add(round([11, 0, 11], expect));
    assert_eq!(all.failures.len(), 1, "a round is not diluted by another");
}

#[test]
fn known_limits_are_of_techniques_on_cases() {
    let techniques = techniques().unwrap();
    for known in limits::all() {
        let used = cases::all().any(|case| {
            let mut names = techniques.iter().map(|technique| &technique.name);
            names.any(|name| {
                let first = limits::of(case.name, name);
                known.is_of(case.name, name) && first == Some(known.limit)
            })
        });
        let bounded = known.limit.at_most.iter().all(|share| *share < 100.0);
        assert!(used && bounded, "{}, {}", known.case, known.technique);
    }
}

#[test]
fn facing_in_f32_is_a_limit_of_the_ways_that_decide_by_it() {
    let techniques = techniques().unwrap();
    let case = case("Light 1e-6");
    let limited = |software| {
        let mut names = Vec::new();
        for technique in techniques.iter().filter(|one| kind(one) == 2) {
            if expected(&case, technique, software) != Expect::Exact {
                names.push(technique.name.as_ref());
            }
        }
        names
    };
    assert_eq!(limited(true), ["volume-compute", "volume-vertex"]);
    let every = techniques.iter().filter(|one| kind(one) == 2).count();
    assert_eq!(limited(false).len(), every - 1, "all but volume-cpu");
}

#[test]
fn only_false_light_in_stacks_of_256_is_put_down_to_wrapping() {
    let Some(gpu) = Gpu::for_test() else { return };
    let case = case("8-bit");
    let mut wrapping = Vec::new();
    for situation in (case.situations)(&mut Random(0)) {
        let reference = seen(&gpu, &situation);
        let expect = case.volumes.where_it(situation.wraps);
        let fails = |light, may_wrap| {
            let frame = Frame {
                visibility: &drawn(&reference, light),
                interior: Interior::Screen,
                may_wrap,
                reach: None,
            };
            let found = judge("", &reference, &frame, expect).unwrap();
            !found.failures.is_empty()
        };
        // Wrong shadow is no wrap, nor is anything where the renderer said that none can be.
        assert!(fails(0, true) && fails(0, false) && fails(255, false));
        if !fails(255, true) {
            wrapping.push(situation.what.clone());
        }
    }
    assert_eq!(
        wrapping,
        ["256 squares", "512 squares", "128 two-sided boxes"]
    );
}

#[test]
fn edges_that_are_worse_at_seams_than_in_the_middle_fail() {
    let Some(gpu) = Gpu::for_test() else { return };
    let situation = (case("Cube seams").situations)(&mut Random(0)).remove(0);
    let places = [
        situation.scene.light().place.truncate(),
        situation.scene.camera.eye,
    ];
    let places = places.map(|place| place.as_dvec3());
    let reference = seen(&gpu, &situation);
    let right = reference.visibility();
    let rates = |visibility: &[u8]| Rates::of(&reference, visibility, places);
    assert_eq!(rates(&right).failure(), None);
    let spoilt = |at_seams: bool| -> Vec<u8> {
        let pixel = |(at, &right): (usize, &u8)| {
            let hit = reference
                .hit(at as u32 % SIZE[0], at as u32 / SIZE[0])
                .unwrap();
            match seams::is_at_seam(hit.position - places[0]) == at_seams {
                true => 255 - right,
                false => right,
            }
        };
        right.iter().enumerate().map(pixel).collect()
    };
    assert!(rates(&spoilt(true)).failure().is_some());
    assert_eq!(rates(&spoilt(false)).failure(), None);
    assert!(Rates::default().failure().is_some(), "nothing to compare");
}

#[test]
fn shadow_where_nothing_casts_is_not_what_a_map_of_one_texel_may_show() {
    let Some(gpu) = Gpu::for_test() else { return };
    let random = &mut Random(0);
    let light = compare::hard::situation::lamp(random);
    let reference = seen(&gpu, &Situation::new("", light, random));
    let mut visibility = reference.visibility();
    let below = lit_where_nothing_casts(&reference, &visibility).unwrap();
    visibility[below[0]] = 254;
    assert!(lit_where_nothing_casts(&reference, &visibility).is_err());
}

#[test]
fn a_square_without_a_t_junction_is_not_reported_as_one() {
    assert!(t_junction(&mesh::split_square()).outcome.is_ok());
    assert!(t_junction(&mesh::whole_square()).outcome.is_err());
}

#[test]
fn flat_maps_are_tried_under_spots() {
    let spots = cases::all().filter(|case| {
        let situations = (case.situations)(&mut Random(0));
        let mut kinds = situations.iter().map(|one| one.scene.light().kind());
        kinds.any(|kind| kind == LightKind::Spot)
    });
    let names: Vec<&str> = spots.map(|case| case.name).collect();
    assert_eq!(names.len(), 15, "{names:?}");
}

/// What went before changes no bit: not casters that came and went, nor a second view behind.
#[test]
fn frames_around_it_leave_a_picture_as_it_is_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let techniques = techniques().unwrap();
    for case in cases::all().filter(|case| case.course != Course::Fresh) {
        for situation in (case.situations)(&mut Random(0)) {
            let scene = situation.scene.clone();
            let stage = Stage::with_look(&gpu, scene, SIZE, situation.look).unwrap();
            let applies = |technique: &&Technique| trial::applies(&gpu, technique, &situation);
            for technique in techniques.iter().filter(applies) {
                let software = is_software(&gpu);
                if expected(&case, technique, software) == Expect::Nothing {
                    continue;
                }
                // A sun's map lies where its casters were, as long as it holds them.
                let may_lie_elsewhere = match technique.config {
                    Config::Flat { .. } => true,
                    Config::Atlas { .. } => stage.inputs.light.is_directional(),
                    _ => false,
                };
                if case.course == Course::ComeAndGo && may_lie_elsewhere {
                    continue;
                }
                let shadow = || Shadow::new(&gpu, &stage.renderer, technique.clone()).unwrap();
                let course = |course: Course| course.picture(&gpu, &stage, &mut shadow()).unwrap();
                let alone = course(Course::Fresh).visibility;
                let what = format!("{}, {}, {}", case.name, situation.what, technique.name);
                assert!(course(case.course).visibility == alone, "{what}");
                // A caster that stayed away would be missed.
                let mut inputs = stage.inputs.clone();
                inputs.casters.remove(0);
                let less = stage.picture(&gpu, &mut shadow(), &inputs).unwrap();
                assert!(less.visibility != alone, "{what}");
            }
        }
    }
}

/// A row of the table: what each technique got wrong, and why.
fn row(name: &'static str, found: [(usize, Option<&'static str>); 3]) -> Row {
    let outcome = |(wrong, why): (usize, Option<&'static str>)| Outcome {
        counted: 100,
        wrong,
        limits: why.into_iter().collect(),
        ..Outcome::default()
    };
    Row {
        name,
        build: "",
        answer: "",
        outcomes: found.map(|found| Some(outcome(found))).into(),
        picture: Vec::new(),
        of_atlas: false,
    }
}

#[test]
fn a_cause_is_named_once_with_all_that_it_does() {
    let names = ["cube-textbook", "cube-hard", "cube-2x2"].map(str::to_owned);
    let (bias, thin) = (Some("a bias"), Some("thin casters"));
    let rows = [
        row("One", [(1, bias), (2, thin), (2, thin)]),
        row("Two", [(1, bias), (2, thin), (3, thin)]),
    ];
    let page = causes::markdown(&names, &rows);
    let causes = ["**A bias.**", "**Thin casters.**"];
    assert_eq!(causes.map(|cause| page.matches(cause).count()), [1, 1]);
    let [bias_at, thin_at] = causes.map(|cause| page.find(cause).unwrap());
    assert!(
        thin_at < bias_at,
        "what only textbooks get wrong comes last"
    );
    let line = |line: &str| page.contains(line);
    assert!(line("| One | cube-hard, cube-2x2 | 0 of 100 | 2.000 % |"));
    assert!(line("| Two | cube-hard | 0 of 100 | 2.000 % |"));
    assert!(line("| Two | cube-2x2 | 0 of 100 | 3.000 % |"));
    // Two causes are two entries.
    let apart = [row("One", [(1, bias), (2, thin), (2, Some("its kernel"))])];
    let page = causes::markdown(&names, &apart);
    assert_eq!(page.matches("| Case |").count(), 3);
}
