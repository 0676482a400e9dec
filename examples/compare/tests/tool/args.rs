//! The command line of the comparison: defaults, what is accepted, and one line for each mistake.

use std::path::PathBuf;

use shadows::glam::{Vec3, Vec4};

use compare::args::{Args, Ground};
use compare::table::ROWS;
use compare::technique::Config;
use host::scene::{LightKind, Time};

fn read(line: &str) -> Args {
    let items = std::iter::once("compare").chain(line.split_whitespace());
    compare::args::try_parse_from(items).unwrap_or_else(|e| panic!("{line}: {e}"))
}

/// The line a user sees instead.
fn mistake(line: &str) -> String {
    let items = std::iter::once("compare").chain(line.split_whitespace());
    let error = compare::args::try_parse_from(items).expect_err(line);
    assert_eq!(error.exit_code(), 2, "{line}");
    let told = compare::args::one_line(&error);
    assert!(!told.contains('\n') && told.len() > 20, "{line}: {told:?}");
    told
}

#[track_caller]
fn assert_refused(line: &str, reason: &str) {
    let told = mistake(line);
    assert!(told.contains(reason), "{line}: {told}");
}

#[test]
fn nothing_given_means_the_defaults() {
    let args = read("");
    assert_eq!(args.scenes, ["spheres"]);
    assert_eq!((args.size, args.face), ([1280, 720], 1024));
    assert_eq!((args.frames, args.seed), (8, 1));
    assert!(args.techniques.are_usual());
    assert_eq!(args.light_kind, None);
    assert_eq!(args.ground, Ground::Auto);
    assert_eq!(args.out, PathBuf::from("target/compare"));
    assert_eq!((args.light, args.range), (None, None));
    assert_eq!(
        (args.camera_override(), args.adapter, args.export),
        (None, None, false)
    );
}

#[test]
fn every_option_is_read() {
    let args = read(
        "--scene a/bunny.obj --scene courtyard --ground none --light -1,2.5,-3 --range 12 --light-kind spot \
         --camera -1,2,3,0,0,0,60 --size 640x480 --technique volume,cube-16 --face 512 \
         --frames 3 --seed 42 --adapter llvm --export --out x/y",
    );
    assert_eq!(args.scenes, ["a/bunny.obj", "courtyard"]);
    assert_eq!(args.ground, Ground::None);
    assert_eq!(args.light, Some(Vec4::new(-1.0, 2.5, -3.0, 1.0)));
    assert_eq!(args.range, Some(12.0));
    let camera = (
        Vec3::new(-1.0, 2.0, 3.0),
        Vec3::ZERO,
        Some(60_f32.to_radians()),
    );
    assert_eq!(args.camera_override(), Some(camera));
    assert_eq!((args.size, args.face), ([640, 480], 512));
    assert_eq!(args.techniques.0, [row("volume"), row("cube-16")]);
    assert_eq!(args.light_kind, Some(LightKind::Spot));
    assert_eq!((args.frames, args.seed), (3, 42));
    assert_eq!(args.adapter.as_deref(), Some("llvm"));
    assert!(args.export);
    assert_eq!(args.out, PathBuf::from("x/y"));
}

#[test]
fn a_light_may_be_a_direction_and_a_camera_keep_its_field_of_view() {
    assert_eq!(read("--light 0,1,0,0").light, Some(Vec4::Y));
    assert_eq!(
        read("--light=0,1,0,1").light,
        Some(Vec4::new(0.0, 1.0, 0.0, 1.0))
    );
    assert_eq!(
        read("--camera 1,1,1,0,0,0").camera_override().unwrap().2,
        None
    );
}

fn row(name: &str) -> &'static compare::table::Row {
    ROWS.iter().find(|row| row.name == name).unwrap()
}

#[test]
fn techniques_are_kept_once_in_the_order_given() {
    let names = |line: &str| -> Vec<&str> {
        let chosen = read(line).techniques.0;
        chosen.iter().map(|row| row.name).collect()
    };
    let all: Vec<&str> = ROWS.iter().map(|row| row.name).collect();
    assert_eq!(
        names("--technique volume,cube-hard,volume"),
        ["volume", "cube-hard"]
    );
    assert_eq!(names("--technique all,volume"), all);
    for name in &all {
        assert_eq!(names(&format!("--technique {name}")), [*name]);
    }
    let told = mistake("--technique cube-8");
    assert!(told.contains("\"cube-8\""), "{told}");
    for name in &all {
        assert!(told.contains(name), "{told}");
    }
}

#[test]
fn a_sweep_takes_limits() {
    let args = read("--sweep --error-at-most 0.001 --time-at-most 2.5ms");
    assert!(args.sweep && !read("").sweep);
    assert_eq!(
        (args.error_at_most, args.time_at_most),
        (Some(0.001), Some(2.5))
    );
}

#[test]
fn shimmer_and_growth_take_a_size_and_a_limit_or_none() {
    assert_eq!((read("").temporal, read("").growth), (None, None));
    let temporal = read("--temporal --steps 8");
    assert_eq!((temporal.temporal, temporal.steps), (Some([320, 180]), 8));
    assert_eq!(read("--temporal 64x36").temporal, Some([64, 36]));
    assert_eq!(read("--growth 16 --frames 2").growth, Some(16.0));
    assert!(read("--growth").growth.is_some_and(|times| times >= 1e5));
    assert_refused("--temporal 64", "WIDTHxHEIGHT");
    assert_refused("--temporal --steps 0", "1..=1000");
    assert_refused("--growth 0.5", "at least 1");
    assert_refused("--growth much", "at least 1");
    assert_refused("--growth --temporal", "--temporal");
    assert_refused("--temporal --sweep", "--sweep");
}

#[test]
fn a_time_is_day_or_night_and_lights_are_counted() {
    assert_eq!((read("").time, read("").lights), (None, None));
    let night = read("--scene city --time night --lights 16");
    assert_eq!((night.time, night.lights), (Some(Time::Night), Some(16)));
    assert_eq!(read("--time day").time, Some(Time::Day));
    assert_refused("--time noon", "day or night");
    assert_refused("--lights 0", "1..=1000");
    assert_refused("--lights 1001", "1..=1000");
}

/// Each mode as it is asked for, and the options that it has a use for beyond those of all.
const MODES: [(&str, &[&str]); 7] = [
    (
        "",
        &[
            "scene",
            "ground",
            "time",
            "lights",
            "light",
            "light-kind",
            "range",
            "camera",
            "technique",
            "size",
            "face",
            "frames",
            "seed",
            "export",
        ],
    ),
    (
        "--sweep",
        &[
            "scene",
            "ground",
            "time",
            "light",
            "light-kind",
            "range",
            "camera",
            "technique",
            "size",
            "frames",
            "error-at-most",
            "time-at-most",
        ],
    ),
    ("--hard-cases", &["case", "rounds"]),
    (
        "--temporal",
        &[
            "scene",
            "ground",
            "time",
            "light",
            "light-kind",
            "range",
            "camera",
            "technique",
            "face",
            "steps",
        ],
    ),
    ("--growth", &["frames"]),
    (
        "--arithmetic",
        &[
            "scene",
            "ground",
            "time",
            "light",
            "light-kind",
            "range",
            "camera",
            "technique",
            "size",
            "face",
            "rounds",
        ],
    ),
    (
        "--cost counts.json",
        &[
            "scene", "ground", "time", "light", "range", "camera", "size", "face",
        ],
    ),
];

/// A mode without its value.
fn bare(mode: &str) -> &str {
    mode.split(' ').next().unwrap_or_default()
}

/// A value that each option takes.
const VALUES: [(&str, &str); 21] = [
    ("scene", "--scene x.obj"),
    ("ground", "--ground none --scene x.obj"),
    ("time", "--time night"),
    ("lights", "--lights 3"),
    ("light", "--light 1,2,3"),
    ("light-kind", "--light-kind spot"),
    ("range", "--range 9"),
    ("camera", "--camera 1,2,3,0,0,0"),
    ("technique", "--technique volume"),
    ("size", "--size 64x36"),
    ("face", "--face 512"),
    ("frames", "--frames 2"),
    ("seed", "--seed 2"),
    ("export", "--export"),
    ("error-at-most", "--error-at-most 0.1"),
    ("time-at-most", "--time-at-most 2ms"),
    ("case", "--case Scale"),
    ("rounds", "--rounds 2"),
    ("steps", "--steps 2"),
    ("adapter", "--adapter llvm"),
    ("out", "--out x"),
];

#[test]
fn what_a_mode_has_no_use_for_is_refused() {
    for (mode, used) in MODES {
        for (option, given) in VALUES {
            let line = format!("{mode} {given}");
            match used.contains(&option) || ["adapter", "out"].contains(&option) {
                true => drop(read(&line)),
                false if mode.is_empty() => assert_refused(&line, "is of no use without --"),
                false => assert_refused(&line, &format!("cannot be used with {}", bare(mode))),
            }
        }
    }
    // Defaults are no use of an option, even where they are written out by nobody.
    assert!(read("--hard-cases").hard_cases);
    for (option, mode) in [("--rounds 2", "--hard-cases"), ("--steps 2", "--temporal")] {
        assert_refused(option, &format!("is of no use without {mode}"));
    }
    for (mode, _) in &MODES[1..] {
        for (other, _) in &MODES[1..] {
            if mode != other {
                assert_refused(&format!("{mode} {other}"), "cannot be used with");
            }
        }
    }
}

#[test]
fn arithmetic_takes_names_or_all() {
    let names = |line| read(line).arithmetic.unwrap();
    assert_eq!(names("--arithmetic"), ["all"]);
    assert_eq!(names("--arithmetic fma,snapped"), ["fma", "snapped"]);
}

#[test]
fn every_option_is_tried_in_every_mode() {
    let command = <Args as clap::CommandFactory>::command();
    let tried = |option: &str| {
        let mode = format!("--{option}");
        VALUES.iter().any(|(known, _)| *known == option)
            || MODES.iter().any(|(known, _)| bare(known) == mode)
    };
    let options: Vec<&str> = command
        .get_arguments()
        .filter_map(|a| a.get_long())
        .collect();
    assert!(options.len() >= VALUES.len());
    for option in options {
        assert!(tried(option), "--{option}");
    }
}

#[test]
fn a_ground_is_for_files() {
    assert_refused(
        "--ground none",
        "--ground is of no use without a model file",
    );
    assert_refused("--ground auto --scene teapot", "built-in scenes");
    let args = read("--ground none --scene teapot --scene x.OBJ");
    assert_eq!(args.ground, Ground::None);
}

#[test]
fn techniques_may_be_named_by_how_they_begin() {
    let names = |line: &str| read(line).techniques.0.len();
    let cubes = names("--technique cube-*");
    assert!(cubes >= 12 && cubes < ROWS.len());
    assert_eq!(names("--technique cube-*,cube-hard"), cubes);
    assert_eq!(
        names("--technique cube-*,flat-*,atlas-*,volume*,planar*,projected*,blob*,baked*,peer-*"),
        ROWS.len()
    );
    let usual = names("--technique usual");
    assert!((5..15).contains(&usual), "{usual} are not few");
    assert_refused("--technique sphere-*", "sphere-*");
}

#[test]
fn every_name_stands_for_another_technique() {
    let settings = |row: &compare::table::Row| format!("{:?}", row.at(512).config);
    for (place, row) in ROWS.iter().enumerate() {
        for other in &ROWS[place + 1..] {
            assert_ne!(row.name, other.name);
            assert_ne!(
                settings(row),
                settings(other),
                "{} {}",
                row.name,
                other.name
            );
        }
    }
    // The kinds by their names.
    for row in ROWS {
        let kind = match row.at(512).config {
            Config::Cube { .. } => "cube",
            Config::Flat { .. } => "flat",
            Config::Volume(_) => "volume",
            Config::Atlas { .. } => "atlas",
            Config::Peer { .. } => "peer",
            Config::Survey(ref survey) => survey.kind(),
        };
        assert!(row.name.starts_with(kind), "{}", row.name);
    }
}

#[test]
fn each_scene_gets_a_directory_of_its_own() {
    let dirs = |line: &str| -> Vec<String> {
        let args = read(line);
        let dirs = args.scene_dirs().into_iter();
        dirs.map(|(_, dir)| dir.display().to_string().replace('\\', "/"))
            .collect()
    };
    assert_eq!(dirs("--out o --scene teapot"), ["o"]);
    assert_eq!(dirs("--out o --scene teapot --scene teapot"), ["o"]);
    let line = "--out o --scene teapot --scene a/x.obj --scene b/x.glb --scene x-2.obj";
    assert_eq!(dirs(line), ["o/teapot", "o/x", "o/x-2", "o/x-2-2"]);
}

#[test]
fn wrong_values_are_refused_with_the_reason() {
    assert_refused("--scene nowhere", "spheres, courtyard, teapot");
    assert_refused("--scene model.stl", ".glb");
    assert_refused("--ground maybe", "auto");
    assert_refused("--light 1,2", "got 2");
    assert_refused("--light 1,2,3,0.5", "w is 0.5");
    assert_refused("--light 0,0,0,0", "direction");
    assert_refused("--light 1,NaN,3", "not finite");
    assert_refused("--light 1,x,3", "\"x\" is not a number");
    assert_refused("--sweep --error-at-most 2", "from 0 to 1");
    assert_refused("--sweep --time-at-most 2", "such as 2ms");
    assert_refused("--sweep --time-at-most=-2ms", "--time-at-most");
    assert_refused("--error-at-most 0.1", "--sweep");
    assert_refused("--light-kind sun", "point, spot or directional");
    assert_refused("--range 0", "above 0");
    assert_refused("--range -1", "above 0");
    assert_refused("--range inf", "not finite");
    assert_refused("--camera 1,2,3,1,2,3", "same point");
    assert_refused("--camera 1,2,3,1,0,3", "straight above or below");
    assert_refused("--camera 1,2,3,0,0,0,180", "field of view");
    assert_refused("--camera 1,2,3", "got 3");
    assert_refused("--size 1280", "WIDTHxHEIGHT");
    assert_refused("--size 0x720", "from 1 to 8192");
    assert_refused("--size 1280x8193", "from 1 to 8192");
    assert_refused("--face 0", "1..=8192");
    assert_refused("--frames 0", "1..=10000");
    assert_refused("--seed -1", "--seed");
}

#[test]
fn wrong_words_are_refused_and_help_is_not_a_mistake() {
    assert_refused("--speed 3", "--speed");
    assert_refused("courtyard", "courtyard");
    assert_refused("--size", "--size");
    let help = compare::args::try_parse_from(["compare", "--help"]).expect_err("help");
    assert_eq!(help.exit_code(), 0);
    assert!(help.to_string().contains("--technique"));
}
