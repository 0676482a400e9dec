//! Whatever arithmetic a driver may choose, shadows are right.

use std::path::Path;

use compare::arithmetic::table::Table;
use compare::arithmetic::trial::{Found, Row, Wrong};
use compare::arithmetic::variant::{ALL, Variant, WRONG};
use compare::hard::cases::{self, Case};
use compare::hard::outcome::Outcome;
use compare::hard::trial::Trial;
use compare::technique::{Config, Technique};
use host::gpu::Gpu;
use shadows::wgpu::{self, util::DeviceExt as _};
use shadows::{Method, ShadowVolumeDescriptor};

/// A device whose shaders have f64, from which `fma` is made.
fn gpu() -> Option<Gpu> {
    let gpu = Gpu::for_test()?;
    if gpu.info.device_type != wgpu::DeviceType::Cpu {
        eprintln!("skipped: a GPU has arithmetic of its own");
        return None;
    }
    let features = gpu.device.features();
    if !features.contains(wgpu::Features::SHADER_F64) {
        eprintln!("skipped: no f64 in shaders");
        return None;
    }
    Some(gpu)
}

fn variant(name: &str) -> Variant {
    Variant::named(name).unwrap()
}

fn case(start: &str) -> Case {
    cases::all()
        .find(|case| case.name.starts_with(start))
        .unwrap()
}

fn techniques(names: &[&str]) -> Vec<Technique> {
    let mut all = compare::hard::techniques().unwrap();
    all.retain(|technique| names.contains(&technique.name.as_ref()));
    assert_eq!(all.len(), names.len());
    all
}

/// One round of a case, what each technique came to.
fn tried(gpu: &Gpu, variant: Variant, case: &Case, techniques: &[Technique]) -> Vec<Outcome> {
    let _installed = variant.install(compare::hard::SIZE);
    let trial = Trial {
        gpu,
        case,
        techniques,
        limits: compare::arithmetic::bounds::of(variant.name),
    };
    let row = trial.run(1, &compare::progress::progress(1, "")).unwrap();
    row.outcomes.into_iter().flatten().collect()
}

const SUMS: &str = "
@group(0) @binding(0) var<storage, read> given: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> found: array<vec4f>;
fn with_product(a: f32, b: f32, c: f32) -> f32 {
    return c + a * b;
}
@compute @workgroup_size(64)
fn sums(@builtin(global_invocation_id) id: vec3u) {
    let v = given[id.x];
    found[2u * id.x] = vec4f(
        with_product(v.x, v.y, v.z),
        v.x * v.y - v.z * v.w,
        v.x + v.y - v.z,
        v.x / v.y,
    );
    found[2u * id.x + 1u] = vec4f(
        dot(v.xyz, vec3f(v.w, 1.7, 2.3)),
        (mat2x2f(v.x, v.y, v.z, v.w) * v.yx).y,
        sqrt(abs(v.x)),
        (mat2x2f(v.x, v.y, v.z, v.w) * (mat2x2f(v.y, v.z, v.w, v.x) * v.wz)).x,
    );
}
";

const COUNT: usize = 4096;

/// Four numbers each, of many digits.
fn numbers() -> Vec<[f32; 4]> {
    let mut random = host::random::Random(7);
    (0..COUNT)
        .map(|_| [0.0; 4].map(|_: f32| random.within(0.5, 8.0)))
        .collect()
}

fn sums(gpu: &Gpu, variant: Variant, numbers: &[[f32; 4]]) -> Vec<[f32; 8]> {
    let device = &gpu.device;
    let text = variant.rewrite(SUMS, [1, 1]);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("sums"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage,
        })
    };
    let storage = wgpu::BufferUsages::STORAGE;
    let given = buffer(bytemuck::cast_slice(numbers), storage);
    let zeros = vec![0; 32 * numbers.len()];
    let found = buffer(&zeros, storage | wgpu::BufferUsages::COPY_SRC);
    let entries = [&given, &found].map(|buffer| buffer.as_entire_binding());
    let mut binding = 0..;
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries.map(|resource| wgpu::BindGroupEntry {
            binding: binding.next().unwrap(),
            resource,
        }),
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups((numbers.len() / 64) as u32, 1, 1);
    });
    bytemuck::pod_collect_to_vec(&gpu.read_buffer(&found))
}

/// What of four numbers a variant makes.
type Sum = fn([f32; 4]) -> f32;

/// A variant, which of the eight sums is asked, and what it must be to the last bit.
const EXPECTED: [(&str, usize, Sum); 16] = [
    ("as-written", 0, |[a, b, c, _]| c + a * b),
    ("as-written", 1, |[a, b, c, d]| a * b - c * d),
    ("as-written", 2, |[a, b, c, _]| a + b - c),
    ("as-written", 3, |[a, b, ..]| a / b),
    ("fma", 0, |[a, b, c, _]| a.mul_add(b, c)),
    ("fma", 1, |[a, b, c, d]| (-c).mul_add(d, a * b)),
    ("fma", 4, |[a, b, c, d]| {
        c.mul_add(2.3, b.mul_add(1.7, a * d))
    }),
    ("fma", 5, |[a, b, _, d]| d.mul_add(a, b * b)),
    ("fma-other", 0, |[a, b, c, _]| a.mul_add(b, c)),
    ("fma-other", 1, |[a, b, c, d]| a.mul_add(b, -(c * d))),
    ("fma-other", 4, |[a, b, c, d]| {
        a.mul_add(d, b.mul_add(1.7, c * 2.3))
    }),
    ("reassociated", 2, |[a, b, c, _]| a + (b - c)),
    ("reassociated", 4, |[a, b, c, d]| {
        (c * 2.3 + b * 1.7) + a * d
    }),
    ("reciprocal", 3, |[a, b, ..]| a * (1.0 / b)),
    ("host-fma", 0, |[a, b, c, _]| c + a * b),
    ("caps-and-sides", 0, |[a, b, c, _]| c + a * b),
];

#[test]
fn each_variant_rounds_as_it_says() {
    let Some(gpu) = gpu() else { return };
    let numbers = numbers();
    let plain = sums(&gpu, variant("as-written"), &numbers);
    for (name, place, expected) in EXPECTED {
        let found = sums(&gpu, variant(name), &numbers);
        for (found, &given) in found.iter().zip(&numbers) {
            assert_eq!(found[place], expected(given), "{name}, {place}: {given:?}");
        }
        // And that is another number than what is written comes to, now and then.
        let others = |(one, other): &(&[f32; 8], &[f32; 8])| one[place] != other[place];
        let differ = found.iter().zip(&plain).filter(others).count();
        let changes = !["as-written", "host-fma", "caps-and-sides"].contains(&name);
        assert_eq!(differ > COUNT / 50, changes, "{name}, {place}: {differ}");
    }
}

#[test]
fn approximate_numbers_are_off_by_up_to_two_units() {
    let Some(gpu) = gpu() else { return };
    let numbers = numbers();
    let found = sums(&gpu, variant("approximate"), &numbers);
    for (place, exact) in [(3, (|[a, b, ..]| a / b) as Sum), (6, |[a, ..]| a.sqrt())] {
        let units = found.iter().zip(&numbers).map(|(found, &given)| {
            let [found, exact] = [found[place], exact(given)].map(f32::to_bits);
            i64::from(found) - i64::from(exact)
        });
        let units: Vec<i64> = units.collect();
        assert!(
            units.iter().all(|units| (-2..=3).contains(units)),
            "{place}"
        );
        assert!(units.iter().filter(|units| **units != 0).count() > COUNT / 2);
    }
}

#[test]
fn written_again_a_picture_stays_the_same() {
    let Some(gpu) = gpu() else { return };
    let case = case("Mirrored");
    let techniques = techniques(&["cube-7x7", "flat-2x2", "volume-compute", "volume-zfail"]);
    let trial = Trial {
        gpu: &gpu,
        case: &case,
        techniques: &techniques,
        limits: &[],
    };
    let plain = trial.run(1, &compare::progress::progress(1, "")).unwrap();
    let plain: Vec<Outcome> = plain.outcomes.into_iter().flatten().collect();
    assert_eq!(
        tried(&gpu, variant("as-written"), &case, &techniques),
        plain
    );
    // Every error is counted the same; other arithmetic counts others.
    let others = ["fma", "reassociated", "snapped"].map(variant);
    assert!(
        others
            .iter()
            .any(|other| tried(&gpu, *other, &case, &techniques) != plain)
    );
}

#[test]
fn no_shader_of_the_library_escapes() {
    fn sources(dir: &Path, found: &mut Vec<std::path::PathBuf>) {
        for entry in std::fs::read_dir(dir).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => sources(&path, found),
                false => found.push(path),
            }
        }
    }
    let mut found = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../src");
    sources(&root, &mut found);
    let makes = |path: &&std::path::PathBuf| {
        let text = std::fs::read_to_string(path).unwrap();
        let code = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        code.into_iter()
            .any(|line| line.contains(".create_shader_module("))
    };
    let mut makers: Vec<_> = found.iter().filter(makes).collect();
    makers.sort();
    // Beside it, a unit test.
    let expected = ["shader.rs", "volume/agreement.rs"].map(|name| root.join(name));
    assert!(makers.iter().copied().eq(&expected), "{makers:?}");
}

#[test]
fn arithmetic_that_no_driver_may_choose_is_found() {
    let Some(gpu) = gpu() else { return };
    let case = case("Equal-depth");
    for (wrong, name) in WRONG.into_iter().zip(["volume-zfail", "cube-hard"]) {
        let [outcome] = &tried(&gpu, wrong, &case, &techniques(&[name]))[..] else {
            panic!("one technique, one outcome");
        };
        assert!(!outcome.failures.is_empty(), "{}: {outcome:?}", wrong.name);
    }
}

/// The pipelines of volumes that reach beyond a far plane are given constants, of which naga makes a function that
/// is not valid where it has been put in the place of a call with constants.
#[test]
fn volumes_behind_a_far_plane_are_drawn_with_other_arithmetic_too() {
    let Some(gpu) = gpu() else { return };
    let case = case("Depth clamp");
    let techniques = techniques(&["volume-compute", "volume-zfail"]);
    for variant in ["as-written", "fma"].map(variant) {
        let outcomes = tried(&gpu, variant, &case, &techniques);
        assert_eq!(outcomes.len(), 2);
        for outcome in outcomes {
            assert!(outcome.failures.is_empty(), "{}: {outcome:?}", variant.name);
            assert!(outcome.counted > 0);
        }
    }
}

/// Where a variant gives more interior pixels than no other arithmetic, the table says so; and nowhere else.
#[test]
fn the_table_names_what_has_risen() {
    let found = |technique: &str, percent, interior| Found {
        what: "A case".into(),
        technique: technique.into(),
        is_volume: technique.starts_with("volume"),
        wrong: Wrong { percent, interior },
    };
    let row = |name, found| Row {
        variant: variant(name),
        found,
        failures: Vec::new(),
    };
    let of = |interior| Table {
        driver: String::new(),
        date: String::new(),
        command: String::new(),
        size: [1, 1],
        rounds: 1,
        rows: vec![
            row(
                "as-written",
                vec![found("cube-hard", 0.5, 3), found("volume", 0.1, 2)],
            ),
            row(
                "fma",
                vec![found("cube-hard", 0.25, 3), found("volume", 0.25, interior)],
            ),
        ],
    };
    let greatest =
        |interior: &str| format!("| `fma` | 0 | 0 | 0.1500 (A case, `volume`) | {interior} | 0 |");
    let risen = "| A case | `volume` | `fma` | 2 | 9 | 0.1000 % | 0.2500 % |";
    let (more, same) = (of(9).markdown(), of(2).markdown());
    assert!(more.contains(&greatest("7 (A case, `volume`)")), "{more}");
    assert!(more.contains(risen), "{more}");
    assert!(same.contains(&greatest("0")), "{same}");
    assert_eq!(same.matches("A case").count(), 1, "{same}");
}

/// Few of the hard cases, which `compare --arithmetic all` tries all.
const CASES: [&str; 2] = ["Equal-depth light pass", "Light 1e-6 from a tilted caster"];

#[test]
fn every_variant_stays_within_its_bounds() {
    let Some(gpu) = gpu() else { return };
    let techniques = techniques(&["cube-hard", "volume-compute", "volume-zfail"]);
    for case in CASES.map(case) {
        for variant in ALL {
            for outcome in tried(&gpu, variant, &case, &techniques) {
                let failures = &outcome.failures;
                assert!(
                    failures.is_empty(),
                    "{}, {}: {failures:?}",
                    variant.name,
                    case.name
                );
            }
        }
    }
}

#[test]
fn caps_of_a_large_ground_under_another_host_want_a_larger_bias() {
    let Some(gpu) = gpu() else { return };
    let case = case("Flat caster");
    let with = |cap_bias_ulps| Technique {
        name: "volume-zfail".into(),
        config: Config::Volume(ShadowVolumeDescriptor {
            method: Method::ZFail,
            cap_bias_ulps,
            ..compare::table::volume()
        }),
    };
    let tried = |name, ulps| tried(&gpu, variant(name), &case, &[with(ulps)]).remove(0);
    let [default, more] = [16, 512].map(|ulps| tried("host-fma", ulps));
    // The broken twin: the default is not enough, within its bound.
    assert!(default.false_shadow > 0 && default.failures.is_empty());
    assert_eq!(more.interior(), 0);
    assert_eq!(tried("as-written", 512).interior(), 0);
}

/// What a GPU was seen to do, and llvmpipe does not.
#[test]
fn depth_of_snapped_corners_lights_the_ground_under_a_light_that_grazes_it() {
    let Some(gpu) = gpu() else { return };
    let case = case("Grazing");
    let techniques = techniques(&["volume-zfail"]);
    let [snapped, plain] = ["snapped", "as-written"]
        .map(|name| tried(&gpu, variant(name), &case, &techniques).remove(0));
    assert!(snapped.failures.is_empty(), "{:?}", snapped.failures);
    assert!(
        snapped.false_lit > 0 && snapped.false_shadow == 0,
        "{snapped:?}"
    );
    assert_eq!(plain.interior(), 0);
}
