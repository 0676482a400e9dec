//! The sweep of `compare`: which configurations it tries, and that the Rust it advises makes them.

use std::collections::BTreeSet;

use compare::args::Techniques;
use compare::sweep::{Swept, Wishes};
use compare::technique::{Config, Technique};
use shadows::reference::{Candidate, Survey};

fn techniques(list: &str) -> Vec<Technique> {
    compare::sweep::techniques(&list.parse::<Techniques>().unwrap())
}

/// Configurations by name, as the advice writes them: this file is what it wrote, compiled.
fn written() -> Vec<(&'static str, Config)> {
    use shadows::*;
    include!("sweep_snippet.rs")
}

/// One of each kind of change.
const NAMES: [&str; 12] = [
    "cube-2x2 4096",
    "cube-7x7 256",
    "cube-disk 512",
    "cube-vogel 1024",
    "cube-pcss 2048",
    "cube-textbook 512",
    "cube-2x2 1024, linear 16 bits",
    "cube-2x2 1024, fourfold bias",
    "cube-2x2 1024, far sides",
    "flat-disk-full 256",
    "volume z-fail, vertex",
    "volume-textbook",
];

/// What `sweep_snippet.rs` is to hold.
fn generated(techniques: &[Technique]) -> String {
    let mut text =
        "// What the advice of `compare --sweep` says; see sweep.rs beside it.\nvec![\n".to_owned();
    for name in NAMES {
        let technique = techniques.iter().find(|technique| technique.name == name);
        let config = &technique.unwrap_or_else(|| panic!("no {name}")).config;
        let result = match config {
            Config::Cube { .. } => "Config::Cube { map, sampler }",
            Config::Flat { .. } => "Config::Flat { map, sampler }",
            Config::Volume(_) => "Config::Volume(volumes)",
            _ => unreachable!("it is not swept"),
        };
        let snippet = compare::snippet::of(config);
        text += &format!("(\"{name}\", {{\n{snippet}{result}\n}}),\n");
    }
    text + "]\n"
}

#[test]
fn the_rust_that_is_advised_makes_exactly_the_configuration() {
    let all = techniques("all");
    let text = generated(&all);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/tool/sweep_snippet.rs");
    if std::env::var_os("SHADOWS_WRITE_SNIPPETS").is_some() {
        std::fs::write(path, &text).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap();
    assert_eq!(
        committed, text,
        "set SHADOWS_WRITE_SNIPPETS=1 and run again"
    );
    let written = written();
    assert_eq!(written.len(), NAMES.len());
    for (name, config) in &written {
        let technique = all
            .iter()
            .find(|technique| technique.name == *name)
            .unwrap();
        assert_eq!(
            format!("{config:?}"),
            format!("{:?}", technique.config.kept())
        );
        // What keeps nothing was timed, but is advised to nobody.
        assert!(config.keeps() && !technique.config.keeps(), "{name}");
    }
    assert!(!text.contains("cache") && !text.contains("keep_between_frames"));
    // The twin: a snippet says nothing of another configuration.
    let [(_, first), (_, second), ..] = written.as_slice() else {
        panic!("too few")
    };
    assert_ne!(compare::snippet::of(first), compare::snippet::of(second));
}

#[test]
fn every_configuration_has_a_snippet_of_its_own() {
    let all = techniques("all");
    let snippets: BTreeSet<String> = all
        .iter()
        .map(|t| compare::snippet::of(&t.config))
        .collect();
    let configurations: BTreeSet<String> = all
        .iter()
        .map(|t| format!("{:?}", t.config.kept()))
        .collect();
    let names: BTreeSet<&str> = all.iter().map(|t| t.name.as_ref()).collect();
    assert_eq!(names.len(), all.len());
    assert_eq!(snippets.len(), configurations.len());
    // Two that differ in keeping alone are one piece of advice.
    let timed: BTreeSet<String> = all.iter().map(|t| format!("{:?}", t.config)).collect();
    assert!(
        (100..timed.len()).contains(&configurations.len()),
        "{}",
        configurations.len()
    );
}

#[test]
fn techniques_that_were_asked_for_are_the_only_ones() {
    let asked = techniques("cube-2x2,volume");
    let rows = |technique: &Technique| technique.name.split(' ').next().unwrap().to_owned();
    let rows: BTreeSet<String> = asked.iter().map(rows).collect();
    assert_eq!(rows.into_iter().collect::<Vec<_>>(), ["cube-2x2", "volume"]);
    // The cheap and the baked ones by name: once, or in each size.
    let is_cheap = |technique: &Technique| matches!(technique.config, Config::Survey(_));
    assert!(!techniques("usual").iter().any(is_cheap));
    for (row, count) in [
        ("planar", 1),
        ("blob-decals", 1),
        ("planar-soft", 5),
        ("projected", 5),
        ("baked", 3),
    ] {
        let swept = techniques(row);
        assert!(swept.len() == count && swept.iter().all(is_cheap), "{row}");
    }
    // What is kept between frames only by name.
    assert!(
        techniques("usual")
            .iter()
            .all(|technique| !technique.config.keeps())
    );
    assert!(
        techniques("cube-cached")
            .iter()
            .all(|technique| technique.config.keeps())
    );
}

/// The first sizes of cube-2x2 with these times and errors.
fn surveyed(measured: &[(f64, f64)]) -> Survey<Technique> {
    let candidates = techniques("cube-2x2").into_iter().zip(measured);
    Survey::new(
        candidates
            .map(|(configuration, &(time, error))| Candidate {
                configuration,
                time,
                error,
            })
            .collect(),
    )
}

#[test]
fn what_was_refused_is_no_mark_and_does_not_count() {
    let measured = [(1.0, 0.01), (2.0, 0.001), (f64::NAN, f64::NAN)];
    let (all, finite) = (surveyed(&measured), surveyed(&measured[..2]));
    let svg = |survey| compare::plot::fronts("title", survey).unwrap();
    assert_eq!(svg(&all), svg(&finite));
    assert_ne!(svg(&finite), svg(&surveyed(&measured[..1])));
    let swept = Swept {
        survey: all,
        spread: None,
        left_out: [("cube-2x2 1024".into(), "no such thing".into())].into(),
    };
    let wishes = Wishes {
        error_at_most: None,
        time_at_most: None,
    };
    let page = compare::sweep::markdown(&swept, "title", [2, 1], 1, &wishes);
    assert!(page.contains(": 2 configurations at 2x1"), "{page}");
    assert!(page.contains("`cube-2x2 1024` is left out: no such thing."));
    assert!(!page.contains("NaN"));
}

#[test]
fn advice_names_the_configuration_and_its_figures() {
    let survey = surveyed(&[(1.0, 0.01), (2.0, 0.001), (4.0, 0.0)]);
    let advice = |error_at_most, time_at_most| {
        compare::sweep::advice(
            &survey,
            &Wishes {
                error_at_most,
                time_at_most,
            },
        )
    };
    let told = advice(Some(0.005), Some(1.5));
    assert!(
        told[0].contains("`cube-2x2 512`, 2.00 ms, 0.1000 %"),
        "{}",
        told[0]
    );
    assert!(told[0].contains("size: 512,"), "{}", told[0]);
    assert!(told[1].contains("`cube-2x2 256`, 1.00 ms"), "{}", told[1]);
    assert!(advice(None, Some(0.5))[0].ends_with("none."));
    assert!(advice(None, None).is_empty());
    let page = |time_at_most| {
        let error_at_most = None;
        let wishes = Wishes {
            error_at_most,
            time_at_most,
        };
        let swept = Swept {
            survey: surveyed(&[(1.0, 0.01)]),
            spread: None,
            left_out: Default::default(),
        };
        compare::sweep::markdown(&swept, "title", [2, 1], 1, &wishes)
    };
    assert!(page(Some(1.5)).contains("anything static is kept"));
    assert!(!page(Some(0.5)).contains("anything static is kept"));
}

#[test]
fn half_of_the_times_lie_within_the_spread() {
    assert_eq!(compare::sweep::spread(&[10.0; 3]), 0.0);
    // Away from 10: 2, 1, 0, 1, 4.
    assert_eq!(compare::sweep::spread(&[8.0, 9.0, 10.0, 11.0, 14.0]), 0.1);
}
