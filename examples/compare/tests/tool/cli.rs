//! `compare` as a user meets it: what it says, what it writes, how it exits.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;

const TECHNIQUES: [&str; 5] = ["cube-hard", "cube-2x2", "cube-16", "cube-pcss", "volume"];

/// The program: cargo puts it beside the folder of this test's own.
fn program() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let profile = test.parent().and_then(Path::parent).unwrap();
    let name = format!("compare{}", std::env::consts::EXE_SUFFIX);
    let program = profile.join("examples").join(name);
    assert!(
        program.exists(),
        "{} is missing; `cargo test` builds it, `cargo test --test` needs `cargo build --example compare` before",
        program.display()
    );
    program
}

/// A directory of its own for one test, empty, gone at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(test: &str) -> Self {
        // Tests run beside each other, and some take several.
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("shadows-{test}-{}-{count}", std::process::id());
        let dir = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&dir);
        fs::create_dir_all(&dir).unwrap();
        Self(dir)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn files(&self, dir: &str) -> BTreeSet<String> {
        let entries = fs::read_dir(self.0.join(dir)).unwrap();
        entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn compare(args: &[&str]) -> Output {
    Command::new(program()).args(args).output().unwrap()
}

/// The least that a scene takes.
const SMALL: [&str; 6] = ["--size", "16x9", "--frames", "1", "--technique", "volume"];

/// Exit code 2, one line that holds `part`, nothing written.
fn assert_refused(args: &[&str], part: &str) {
    let scratch = Scratch::new("refused");
    let out = scratch.path("out");
    let output = compare(&[args, &["--out", &out]].concat());
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {told}");
    // Drivers may say things of their own before.
    let last = told.lines().last().unwrap_or_default();
    assert!(last.contains(part), "{args:?}: {told}");
    assert_eq!(told.matches(last).count(), 1, "{args:?}: {told}");
    assert!(!told.contains("panicked"), "{told}");
    assert!(output.stdout.is_empty());
    assert!(scratch.files("").is_empty(), "{args:?} wrote something");
}

#[test]
fn bad_arguments_are_refused_in_one_line() {
    for (args, part) in [
        (&["--scene", "moon"][..], "spheres"),
        (&["--technique", "cube-9x9"], "cube-2x2"),
        (&["--light", "1,2"], "numbers"),
        (&["--light", "1,2,3,0.5"], "w is 0.5"),
        (&["--range", "0"], "above 0"),
        (&["--camera", "1,2,3,1,2,3"], "same point"),
        (&["--size", "0x10"], "WIDTHxHEIGHT"),
        (&["--face", "0"], "--face"),
        (&["--frames", "many"], "many"),
        (&["--growth", "--rounds", "2"], "--rounds"),
        (&["--hard-cases", "--steps", "2"], "--steps"),
        (&["--nonsense"], "--nonsense"),
    ] {
        assert_refused(args, part);
    }
}

#[test]
fn broken_models_are_refused_in_one_line() {
    let models = Scratch::new("models");
    assert_refused(&["--scene", &models.path("none.obj")], "none.obj");
    for (name, content) in [
        ("empty.obj", ""),
        ("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
        ("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("broken.glb", "glTF but not really"),
    ] {
        let path = models.path(name);
        fs::write(&path, content).unwrap();
        assert_refused(&["--scene", &path], name);
    }
    // The first scene is fine, and is not written either.
    let path = models.path("empty.obj");
    assert_refused(&["--scene", "teapot", "--scene", &path], "empty.obj");
}

#[test]
fn a_light_map_is_not_watched_while_its_light_moves() {
    let args = ["--temporal", "--technique", "baked", "--steps", "1"];
    assert_refused(&args, "a light that stands");
}

/// The time of a bake stands beside those of frames, in none of them.
#[test]
fn a_bake_is_told_of() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("baked");
    let out = scratch.path("out");
    let of = ["--scene", "floor", "--technique", "baked,planar"];
    let small = ["--size", "64x36", "--frames", "1", "--face", "128"];
    let output = compare(&[&of[..], &small, &["--out", &out]].concat());
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let report = fs::read_to_string(scratch.0.join("out/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let baked = &report["techniques"][0]["bake"];
    let figure = |name: &str| baked[name].as_f64().unwrap();
    let texel = figure("texel");
    assert!(
        figure("seconds") > 0.0 && figure("filled_percent") > 50.0,
        "{baked}"
    );
    assert!((0.1..0.3).contains(&texel), "{baked}");
    assert!(report["techniques"][1]["bake"].is_null());
    let page = fs::read_to_string(scratch.0.join("out/report.md")).unwrap();
    let line = page
        .lines()
        .find(|line| line.starts_with("- `baked`"))
        .unwrap();
    assert!(line.contains("baked once, in"), "{line}");
    assert!(
        line.contains(&format!("a texel is {:.2} cm", 100.0 * texel)),
        "{line}"
    );
}

#[test]
fn maps_alone_are_refused_for_lights_of_the_other_kind() {
    let args = ["--light", "1,2,3,0", "--technique", "cube-hard,cube-16"];
    assert_refused(&args, "directional");
    assert_refused(&["--technique", "flat-*"], "--light-kind");
    let shimmer = [
        "--temporal",
        "--light",
        "1,2,3,0",
        "--technique",
        "cube-2x2",
    ];
    assert_refused(&shimmer, "directional");
    let placeless = ["--light", "1,2,3,0", "--light-kind", "spot"];
    assert_refused(&placeless, "no place");
}

#[test]
fn times_and_lights_that_a_scene_has_not_are_refused() {
    assert_refused(
        &["--time", "night"],
        "scene spheres: it has no day and no night",
    );
    assert_refused(&["--scene", "valley", "--time", "night"], "it has no night");
    assert_refused(&["--lights", "2"], "--lights 2 is too many, it has 1");
    let one = [
        "--scene", "city", "--time", "night", "--light", "0,5,0", "--lights", "3",
    ];
    assert_refused(&one, "--lights 3 is too many, it has 1");
}

#[test]
fn an_adapter_that_is_not_there_is_named() {
    assert_refused(&["--adapter", "no such adapter"], "adapter");
}

#[test]
fn a_file_in_the_way_is_left_alone() {
    let scratch = Scratch::new("in-the-way");
    let out = scratch.path("out");
    fs::write(&out, "mine").unwrap();
    let output = compare(&["--out", &out, "--size", "16x9", "--frames", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(&out).unwrap(), "mine");
}

#[test]
fn what_a_file_holds_besides_is_told() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("left-out");
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (elements, left_out) in [
        ("", None),
        (
            "l 1 2\nl 2 3\np 1\n",
            Some("line elements (2), point elements (1)"),
        ),
    ] {
        let model = scratch.path("model.obj");
        fs::write(&model, format!("{corners}{elements}")).unwrap();
        let out = scratch.path("out");
        let output = compare(&[&SMALL[..], &["--scene", &model, "--out", &out]].concat());
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{told}");
        let markdown = fs::read_to_string(Path::new(&out).join("report.md")).unwrap();
        match left_out {
            None => {
                assert!(!told.contains("left out") && !markdown.contains("Left out of its file"))
            }
            Some(elements) => {
                assert!(
                    told.contains(&format!("model.obj: left out are {elements}")),
                    "{told}"
                );
                assert!(
                    markdown.contains(&format!("Left out of its file: {elements}.")),
                    "{markdown}"
                );
            }
        }
    }
}

#[test]
fn a_range_is_not_for_light_from_one_direction() {
    let args = ["--light", "1,2,3,0", "--range", "5"];
    assert_refused(&args, "a directional light has none");
    assert_refused(&["--light-kind", "directional", "--range", "5"], "--range");
}

#[test]
fn help_is_no_error() {
    let output = compare(&["--help"]);
    assert!(output.status.success());
    assert!(
        String::from_utf8(output.stdout)
            .unwrap()
            .contains("--technique")
    );
}

#[test]
fn a_small_run_writes_everything() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("small");
    let out = scratch.path("made/on/the/way");
    let techniques = TECHNIQUES.join(",");
    let output = compare(&[
        "--size",
        "160x90",
        "--frames",
        "3",
        "--face",
        "128",
        "--export",
        "--out",
        &out,
        "--technique",
        &techniques,
    ]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let mut expected: BTreeSet<String> = [
        "report.json",
        "report.md",
        "speed-vs-error.svg",
        "reference.visibility.png",
        "coverage.png",
        "scene.ply",
    ]
    .map(str::to_owned)
    .into();
    for technique in TECHNIQUES {
        for picture in ["visibility", "shaded", "error"] {
            expected.insert(format!("{technique}.{picture}.png"));
        }
    }
    assert_eq!(scratch.files("made/on/the/way"), expected);
    let dir = Path::new(&out);
    let text = fs::read_to_string(dir.join("report.json")).unwrap();
    check_report(&serde_json::from_str(&text).unwrap());
    check_visibility(dir);
    let markdown = fs::read_to_string(dir.join("report.md")).unwrap();
    let svg = fs::read_to_string(dir.join("speed-vs-error.svg")).unwrap();
    for technique in TECHNIQUES {
        assert!(markdown.contains(&format!("| `{technique}` |")));
        assert!(svg.contains(technique), "{technique} is not in the plot");
    }
}

fn check_report(report: &Value) {
    assert_eq!(report["size"], serde_json::json!([160, 90]));
    let scene = host::scene::spheres();
    let matrix = scene.camera.clip_from_world(160.0 / 90.0).to_cols_array();
    let written: Vec<f32> = floats(&report["camera"]["clip_from_world"]);
    assert_eq!(written, matrix, "not the same f32 numbers");
    assert_eq!(
        floats(&report["lights"][0]["place"]),
        scene.light().place.to_array()
    );
    assert_eq!(
        floats(&report["camera"]["eye"]),
        scene.camera.eye.to_array()
    );
    assert_eq!(
        report["camera"]["fovy"].as_f64().unwrap() as f32,
        scene.camera.fovy
    );
    assert_eq!(report["camera"]["depth"], "reverse-z-infinite");
    for field in ["name", "backend", "driver"] {
        assert!(report["adapter"][field].is_string(), "{field}");
    }
    let objects = report["scene"].as_array().unwrap();
    assert_eq!(objects.len(), scene.objects.len());
    assert!(
        objects
            .iter()
            .any(|o| o["kind"] == "closed" && o["triangles"] == 1536)
    );
    assert!(objects.iter().any(|o| o["kind"] == "general"));
    let facing = report["reference"]["lit_facing"].as_u64().unwrap();
    assert_eq!(report["reference"]["pixels"], 160 * 90);
    assert!(facing > 1000 && facing < 160 * 90);

    let techniques = report["techniques"].as_array().unwrap();
    let names: Vec<&str> = techniques
        .iter()
        .map(|t| t["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, TECHNIQUES);
    for technique in techniques {
        check_technique(technique, facing);
    }
}

fn check_technique(technique: &Value, facing: u64) {
    for work in ["prepare_ms", "generate_ms", "shade_ms"] {
        let times = &technique[work];
        assert_eq!(times["samples"], 3);
        let (median, min) = (&times["median"], &times["min"]);
        assert!(min.as_f64().unwrap() <= median.as_f64().unwrap(), "{work}");
        assert!(times["clock"] == "wall" || times["clock"] == "gpu");
    }
    for work in ["prepare_ms", "generate_ms"] {
        assert!(
            technique[work]["min"].as_f64().unwrap() > 0.0,
            "{technique}"
        );
    }
    for wrong in ["false_lit", "false_shadow"] {
        let pixels = technique[wrong].as_u64().unwrap();
        let percent = technique[format!("{wrong}_percent")].as_f64().unwrap();
        assert_eq!(percent, 100.0 * pixels as f64 / facing as f64);
        let interior = technique[format!("{wrong}_interior")].as_u64().unwrap();
        assert!(interior <= pixels && pixels < facing);
    }
    assert!(technique["rmse"].as_f64().unwrap() < 0.5);
    for cost in ["bytes", "draws", "triangles_drawn"] {
        assert!(technique[cost].as_u64().unwrap() > 0, "{cost}");
    }
    check_soft(technique);
    assert!(
        technique["settings"]
            .as_object()
            .is_some_and(|s| !s.is_empty())
    );
}

/// Only kernels with soft edges are compared with an area light.
fn check_soft(technique: &Value) {
    let soft = &technique["soft"];
    assert_eq!(soft.is_object(), technique["name"] == "cube-pcss");
    if soft.is_object() {
        assert!(soft["pixels"].as_u64().unwrap() > 100, "{soft}");
        assert!(soft["levels"].as_u64().unwrap() > 10, "{soft}");
        for figure in ["area_rmse", "area_largest", "largest_step", "noise"] {
            let value = soft[figure].as_f64().unwrap();
            assert!(value > 0.0 && value <= 1.0, "{figure}: {soft}");
        }
        assert!(soft["flips_percent"].as_f64().unwrap() < 20.0, "{soft}");
    }
}

fn floats(list: &Value) -> Vec<f32> {
    let numbers = list.as_array().unwrap().iter();
    numbers.map(|n| n.as_f64().unwrap() as f32).collect()
}

/// The masks agree with the report: wrong pixels counted again from the pictures.
fn check_visibility(dir: &Path) {
    let read = |name: &str| {
        let (size, pixels) = host::image::read_png(&dir.join(name)).unwrap();
        assert_eq!((size, pixels.len()), ([160, 90], 160 * 90), "{name}");
        pixels
    };
    let text = fs::read_to_string(dir.join("report.json")).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    let (coverage, truth) = (read("coverage.png"), read("reference.visibility.png"));
    for technique in report["techniques"].as_array().unwrap() {
        let seen = read(&format!(
            "{}.visibility.png",
            technique["name"].as_str().unwrap()
        ));
        let wrong = |lit: bool| {
            let pixels = coverage.iter().zip(&truth).zip(&seen);
            pixels
                .filter(|((c, t), s)| **c == 255 && (**t == 255) != lit && (**s >= 128) == lit)
                .count() as u64
        };
        assert_eq!(technique["false_lit"], wrong(true));
        assert_eq!(technique["false_shadow"], wrong(false));
    }
}

#[test]
fn a_sweep_writes_its_table_its_front_and_its_advice() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("sweep");
    let out = scratch.path("out");
    let line = "--sweep --technique volume* --size 96x54 --frames 2 --error-at-most 1 \
                --time-at-most 1000000ms --out";
    let args: Vec<&str> = line.split_whitespace().chain([out.as_str()]).collect();
    let output = compare(&args);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let files: Vec<String> = scratch.files("out").into_iter().collect();
    assert_eq!(files, ["speed-vs-error.svg", "sweep.json", "sweep.md"]);
    let read = |name: &str| fs::read_to_string(Path::new(&out).join(name)).unwrap();
    let rows: Value = serde_json::from_str(&read("sweep.json")).unwrap();
    let rows = rows.as_array().unwrap();
    let times: Vec<f64> = rows.iter().map(|row| row["ms"].as_f64().unwrap()).collect();
    assert!(rows.len() > 8 && times.is_sorted(), "{times:?}");
    // The front begins with the fastest, and advice under no limit but one is its ends.
    assert_eq!(rows[0]["front"], true);
    let (markdown, svg) = (read("sweep.md"), read("speed-vs-error.svg"));
    let fastest = rows[0]["name"].as_str().unwrap();
    assert!(
        markdown.contains(&format!("100 % wrong pixels: `{fastest}`")),
        "{markdown}"
    );
    assert!(markdown.contains("```rust\nlet volumes = ShadowVolumeDescriptor"));
    assert!(markdown.contains("within 1000000 ms a frame: `volume"));
    assert!(svg.contains(fastest));
    for row in rows {
        assert!(markdown.contains(&format!("| `{}` |", row["name"].as_str().unwrap())));
    }
}

/// What `shader_cost` compares with, and this takes.
const COUNTS: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../benches/shader_cost/kept/mesa-22.3.6-navi21.json"
);

#[test]
fn instructions_are_set_against_error_for_every_receiver_that_is_counted() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("cost");
    let run = |counts: &str| {
        let out = scratch.path("out");
        let small = ["--scene", "spheres", "--size", "32x18", "--face", "64"];
        compare(&[&["--cost", counts][..], &small, &["--out", &out]].concat())
    };
    let output = run(COUNTS);
    assert!(output.status.success(), "{output:?}");
    let files = [
        "cost-vs-error.json",
        "cost-vs-error.md",
        "cost-vs-error.svg",
    ];
    assert_eq!(scratch.files("out"), files.map(String::from).into());
    let page = fs::read_to_string(scratch.path("out/cost-vs-error.md")).unwrap();
    let counts = fs::read_to_string(COUNTS).unwrap();
    let rows: Value = serde_json::from_str(&counts).unwrap();
    let names = rows.as_array().unwrap().iter();
    let names = names.map(|row| row["name"].as_str().unwrap().to_owned());
    // An atlas's receivers get wrong what those of its lights' own maps do.
    let names: Vec<String> = names
        .filter(|name| !name.starts_with("atlas-"))
        .filter_map(|name| match name.strip_suffix("/normal") {
            Some(kernel) if !kernel.starts_with("cube-") && !kernel.starts_with("flat-") => {
                Some(kernel.to_owned())
            }
            None if name.starts_with("peer/cube/") || name.starts_with("peer/flat/") => Some(name),
            _ => None,
        })
        .collect();
    assert!(names.len() > 20);
    for name in &names {
        assert!(page.contains(&format!("| `{name}` |")), "{name}\n{page}");
    }
    // One that was not counted is no less than an error.
    for missing in ["peer/cube/three-pcf", "flat/weighted_5/normal"] {
        let fewer = scratch.path("fewer.json");
        fs::write(&fewer, counts.replace(missing, "another")).unwrap();
        let output = run(&fewer);
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(missing), "{told}");
    }
}

#[test]
fn several_scenes_get_a_directory_each_and_other_files_stay() {
    if host::gpu::Gpu::for_test().is_none() {
        return;
    }
    let scratch = Scratch::new("several");
    fs::create_dir_all(scratch.0.join("out/teapot")).unwrap();
    fs::write(scratch.0.join("out/teapot/notes.txt"), "mine").unwrap();
    let out = scratch.path("out");
    let output = compare(&[
        "--scene",
        "spheres",
        "--scene",
        "teapot",
        "--light",
        "1,2,0.5,0",
        "--size",
        "64x36",
        "--frames",
        "1",
        "--out",
        &out,
    ]);
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    assert!(told.contains("cube-2x2 is left out"), "{told}");
    for scene in ["spheres", "teapot"] {
        let files = scratch.files(&format!("out/{scene}"));
        assert!(files.contains("report.json") && files.contains("volume.error.png"));
        assert!(!files.contains("cube-hard.error.png"));
        assert!(!files.iter().any(|name| name.starts_with('.')), "{files:?}");
    }
    // One table of both, beside them.
    let table = fs::read_to_string(scratch.0.join("out/scenes.md")).unwrap();
    assert!(
        table.starts_with("| | `spheres` ms | wrong | interior | `teapot` ms |"),
        "{table}"
    );
    let row = table
        .lines()
        .find(|line| line.starts_with("| `volume` |"))
        .unwrap();
    for scene in ["spheres", "teapot"] {
        let path = scratch.0.join("out").join(scene).join("report.json");
        let report: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
        let mut techniques = report["techniques"].as_array().unwrap().iter();
        let volume = techniques.find(|t| t["name"] == "volume").unwrap();
        let wrong =
            ["false_lit_percent", "false_shadow_percent"].map(|w| volume[w].as_f64().unwrap());
        let time = volume["total_ms"].as_f64().unwrap();
        let cells = format!("| {time:.1} | {:.4} % | ", wrong[0] + wrong[1]);
        assert!(row.contains(&cells), "{cells}: {row}");
    }
    assert_eq!(fs::read_dir(scratch.0.join("out")).unwrap().count(), 3);
    let notes = scratch.0.join("out/teapot/notes.txt");
    assert_eq!(fs::read_to_string(notes).unwrap(), "mine");
}

#[test]
fn days_are_found_across_leap_years() {
    assert_eq!(compare::date::date(0), "1970-01-01");
    assert_eq!(compare::date::date(951_782_400), "2000-02-29");
    assert_eq!(compare::date::date(951_868_800), "2000-03-01");
    assert_eq!(compare::date::date(1_798_761_599), "2026-12-31");
}
