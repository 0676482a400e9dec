//! The function at points in and around penumbrae.

use shadows::glam::{Mat3, Quat, Vec3};
use shadows::{Blob, BlobFrame, BlobLight, DirectionalLight, HomogeneousLight};

use super::ask::{Question, answers, answers_of, errors, truth};
use crate::common::shapes::Random;
use host::gpu::Gpu;

const REACH: f32 = 1e4;

/// An ellipsoid, a light and a point somewhere in or near the penumbra.
struct Trial {
    blob: Blob,
    light: BlobLight,
    at: Vec3,
}

/// Semi-axes of 1/8 to 1, lights of a 50th to a third of their distance.
fn trial(random: &mut Random) -> Trial {
    let mut between = |low: f32, high: f32| low + (high - low) * 0.5 * (1.0 + random.next());
    let semi = Vec3::new(
        between(0.125, 1.0),
        between(0.125, 1.0),
        between(0.125, 1.0),
    );
    let (slope, distance, behind) = (between(0.02, 0.33), between(2.5, 9.0), between(0.1, 3.0));
    let (out, directional) = (between(0.7, 1.3), between(0.0, 1.0) < 0.3);
    let turn = Quat::from_axis_angle(random.vec3().normalize(), 3.0 * random.next());
    let axes = Mat3::from_quat(turn) * Mat3::from_diagonal(semi);
    let blob = Blob {
        centre: random.vec3() * 3.0,
        axes: [axes.x_axis, axes.y_axis, axes.z_axis],
        opacity: 1.0,
    };
    let toward = random.vec3().normalize();
    let place = blob.centre + toward * distance;
    let light = match directional {
        true => BlobLight::new(DirectionalLight::new(toward * 7.0), slope, REACH),
        false => BlobLight::new(HomogeneousLight::point(place), slope * distance, REACH),
    };
    // About where the ray from a place of the light past the outline goes on.
    let outline = toward.any_orthonormal_vector();
    let around = Quat::from_axis_angle(toward, 3.0 * random.next());
    let edge = blob.centre + axes * (axes.transpose() * (around * outline)).normalize() * out;
    let from = place + slope * distance * random.vec3();
    let at = edge + (edge - from).normalize() * behind;
    Trial { blob, light, at }
}

/// So many that are not inside, each with a blob of its own: asked one after another, in frames of one blob.
fn trials(count: usize) -> Vec<Trial> {
    let mut random = Random::new(7);
    let outside = |trial: &Trial| {
        let [x, y, z] = trial.blob.axes;
        let q = Mat3::from_cols(x, y, z).inverse() * (trial.at - trial.blob.centre);
        q.length() > 1.0
    };
    std::iter::repeat_with(|| trial(&mut random))
        .filter(outside)
        .take(count)
        .collect()
}

/// Blobs far apart, of which each light sees one: so one frame asks for all trials.
///
/// Blobs are told apart by `own`, which leaves out one; here all but one are to be left out, so each trial is
/// moved to a place of its own, with the reach of its light ending before the next.
fn apart(trials: &[Trial], scale: f32) -> (Vec<Blob>, Vec<BlobLight>, Vec<Question>) {
    let moved = |place: usize| {
        let at = [place % 7, place / 7 % 7, place / 49].map(|at| 64.0 * at as f32);
        scale * Vec3::from(at)
    };
    let blobs = trials.iter().enumerate().map(|(place, trial)| Blob {
        centre: scale * trial.blob.centre + moved(place),
        ..trial.blob.scaled(scale)
    });
    let lights = trials.iter().enumerate().map(|(place, trial)| {
        let mut light = trial.light;
        let reach = 40.0 * scale;
        if !light.light.is_directional() {
            let at = scale * light.light.xyzw().truncate() + moved(place);
            light = BlobLight::new(HomogeneousLight::point(at), light.radius * scale, reach);
        }
        BlobLight { reach, ..light }
    });
    let questions = trials.iter().enumerate();
    let questions = questions
        .map(|(place, trial)| Question::of(scale * trial.at + moved(place), place as u32))
        .collect();
    (blobs.collect(), lights.collect(), questions)
}

/// What is shown of the trials, and what is true, in batches of 256 lights.
fn measured(
    gpu: &Gpu,
    strips: u32,
    trials: &[Trial],
    change: impl Fn(String) -> String,
) -> (Vec<f32>, Vec<f64>) {
    let (mut shown, mut exact) = (Vec::new(), Vec::new());
    for batch in trials.chunks(256) {
        let (blobs, lights, questions) = apart(batch, 1.0);
        let frame = BlobFrame {
            lights: &lights,
            blobs: &blobs,
            ..Default::default()
        };
        shown.extend(answers_of(gpu, strips, &frame, &questions, &change));
        for ((blob, light), question) in blobs.iter().zip(&lights).zip(&questions) {
            exact.push(truth(blob, light, question.at, 10_000));
        }
    }
    (shown, exact)
}

#[test]
fn an_ellipsoid_has_the_penumbra_of_the_lights_size_and_distance() {
    let Some(gpu) = Gpu::for_test() else { return };
    let trials = trials(1024);
    let of = |strips, change: &dyn Fn(String) -> String| {
        let (shown, exact) = measured(&gpu, strips, &trials, change);
        errors(&shown, &exact)
    };
    let same = |text: String| text;
    let [rms, largest] = of(6, &same);
    println!("6 strips: rms {rms:.4}, largest {largest:.4}");
    assert!(rms < 0.01 && largest < 0.08, "{rms} {largest}");
    // Half of the trials at least are in a penumbra.
    let (_, exact) = measured(&gpu, 1, &trials, same);
    let partly = exact.iter().filter(|v| (0.02..0.98).contains(*v)).count();
    assert!(partly > 400, "{partly}");
    // More strips are better.
    let [few, _] = of(2, &same);
    let [many, most] = of(24, &same);
    println!("2 strips: rms {few:.4}; 24: rms {many:.4}, largest {most:.4}");
    assert!(many < 0.5 * rms && rms < 0.7 * few, "{few} {rms} {many}");
    // What must fail: a hard outline; a penumbra that does not know the light's distance; a sphere around.
    let twins = [
        (
            "hard",
            "max(light.radius / distance, SHADOWS_BLOB_LEAST_SLOPE)",
            "SHADOWS_BLOB_LEAST_SLOPE",
        ),
        ("distance", "light.radius / distance", "light.radius / 8.0"),
        (
            "sphere",
            "return vec3f(dot(blob.row_x.xyz, v), dot(blob.row_y.xyz, v), dot(blob.row_z.xyz, v));",
            "return v / blob.radius;",
        ),
    ];
    for (name, from, to) in twins {
        let [broken, _] = of(6, &|text: String| {
            assert!(text.contains(from), "{from}");
            text.replace(from, to)
        });
        println!("{name}: rms {broken:.4}");
        assert!(broken > 6.0 * rms, "{name}: {broken} against {rms}");
    }
}

#[test]
fn a_scene_of_another_scale_has_the_same_shadows() {
    let Some(gpu) = Gpu::for_test() else { return };
    let trials = trials(256);
    let of = |scale: f32| {
        let (blobs, lights, questions) = apart(&trials, scale);
        let frame = BlobFrame {
            lights: &lights,
            blobs: &blobs,
            ..Default::default()
        };
        answers(&gpu, &frame, &questions)
    };
    let one = of(1.0);
    let largest = |other: &[f32]| {
        let each = one.iter().zip(other).map(|(a, b)| (a - b).abs());
        each.fold(0.0, f32::max)
    };
    // Places of up to 400 are rounded to 0.00003, a thousandth of the smallest disk.
    for scale in [1e-4, 1e5] {
        let difference = largest(&of(scale));
        assert!(difference < 0.02, "{scale}: {difference}");
    }
    // Powers of two are scaled without rounding.
    for scale in [1.0 / 16384.0, 131072.0] {
        let difference = largest(&of(scale));
        assert!(difference < 1e-4, "{scale}: {difference}");
    }
    // The twin: a length that does not scale.
    let (blobs, mut lights, questions) = apart(&trials, 1e5);
    lights.iter_mut().for_each(|light| light.reach = 40.0);
    let frame = BlobFrame {
        lights: &lights,
        blobs: &blobs,
        ..Default::default()
    };
    assert!(largest(&answers(&gpu, &frame, &questions)) > 0.5);
}

/// Visibility of one light past blobs at points.
fn ask(gpu: &Gpu, light: BlobLight, blobs: &[Blob], at: &[Vec3]) -> Vec<f32> {
    let questions: Vec<_> = at.iter().map(|&at| Question::of(at, 0)).collect();
    let frame = BlobFrame {
        lights: &[light],
        blobs,
        ..Default::default()
    };
    answers(gpu, &frame, &questions)
}

fn flat(thickness: f32) -> Blob {
    Blob {
        axes: [Vec3::X, Vec3::Y * thickness, Vec3::Z * 0.5],
        ..Blob::sphere(Vec3::Y * 2.0, 1.0)
    }
}

#[test]
fn what_is_flat_casts_and_what_has_no_area_does_not() {
    let Some(gpu) = Gpu::for_test() else { return };
    let lamp = BlobLight::new(HomogeneousLight::point(Vec3::Y * 6.0), 0.5, REACH);
    let at: Vec<Vec3> = (0..100)
        .map(|i| Vec3::new(0.03 * i as f32, 0.0, 0.01 * i as f32))
        .collect();
    let thin = ask(&gpu, lamp, &[flat(0.0)], &at);
    let exact: Vec<f64> = at
        .iter()
        .map(|&at| truth(&flat(1e-3), &lamp, at, 10_000))
        .collect();
    let [_, largest] = errors(&thin, &exact);
    assert!(largest < 0.03, "{largest}");
    assert!(thin[0] < 0.05 && thin[99] == 1.0);
    // Seen along its plane it is not there, but for its thickness.
    let level = BlobLight::new(DirectionalLight::new(Vec3::X), 0.05, REACH);
    let edge_on = ask(&gpu, level, &[flat(0.0)], &[Vec3::new(-3.0, 2.0, 0.0)]);
    assert!((0.9..1.0).contains(&edge_on[0]), "{edge_on:?}");
    let line = Blob {
        axes: [Vec3::X, Vec3::ZERO, Vec3::X * 0.5],
        ..flat(0.0)
    };
    for nothing in [Blob::sphere(Vec3::Y * 2.0, 0.0), line] {
        assert!(ask(&gpu, lamp, &[nothing], &at).iter().all(|&v| v == 1.0));
    }
    // One of them costs no other its shadow.
    assert_eq!(ask(&gpu, lamp, &[line, flat(0.0)], &at), thin);
}

#[test]
fn what_casts_nothing_is_not_reckoned_with() {
    let Some(gpu) = Gpu::for_test() else { return };
    let sun = BlobLight::new(DirectionalLight::new(Vec3::Y), 0.1, REACH);
    // What is found out about a blob is no number, which shows unless nothing is asked.
    let with = |blob: Blob| {
        let frame = BlobFrame {
            lights: &[sun],
            blobs: &[blob],
            ..Default::default()
        };
        let change = |module: String| {
            let answer =
                "return select(0.0, saturate(covered / f32(SHADOWS_BLOB_STRIPS + 1u)), before);";
            assert!(module.contains(answer));
            module.replace(answer, "return sqrt(-1.0 - distance);")
        };
        answers_of(&gpu, 6, &frame, &[Question::of(Vec3::ZERO, 0)], change)[0]
    };
    let ball = Blob::sphere(Vec3::Y * 2.0, 1.0);
    let clear = Blob {
        opacity: 0.0,
        ..ball
    };
    assert_eq!(with(clear), 1.0);
    assert_eq!(with(Blob::sphere(Vec3::Y * 2.0, 0.0)), 1.0);
    assert!(with(ball).is_nan());
}

#[test]
fn a_receiver_inside_is_dark_where_the_surface_is() {
    let Some(gpu) = Gpu::for_test() else { return };
    let blob = Blob {
        axes: [Vec3::X * 2.0, Vec3::Y, Vec3::Z * 0.7],
        ..Blob::sphere(Vec3::new(5.0, 1.0, 0.0), 1.0)
    };
    let sun = BlobLight::new(DirectionalLight::new(Vec3::Y), 0.1, REACH);
    let along = |radius: f32, down: f32| {
        let unit = Vec3::new(0.3, down, 0.2).normalize() * radius;
        blob.centre + unit * Vec3::new(2.0, 1.0, 0.7)
    };
    for radius in [0.01, 0.5, 0.999, 1.001] {
        let at = [along(radius, 1.0), along(radius, -1.0)];
        let [lit, dark] = ask(&gpu, sun, &[blob], &at)[..] else {
            panic!()
        };
        assert!(lit > 0.99 && dark < 0.01, "{radius}: {lit} {dark}");
    }
    // No step at the surface, in the penumbra of its horizon either.
    let around: Vec<Vec3> = (-50..=50)
        .flat_map(|i| [0.99999, 1.00001].map(|radius| along(radius, 0.02 * i as f32)))
        .collect();
    for pair in ask(&gpu, sun, &[blob], &around).chunks(2) {
        assert!((pair[0] - pair[1]).abs() < 0.1, "{pair:?}");
    }
    let centre = ask(&gpu, sun, &[blob], &[blob.centre]);
    assert_eq!(centre, [1.0]);
}

#[test]
fn a_light_inside_darkens_what_is_behind_the_middle() {
    let Some(gpu) = Gpu::for_test() else { return };
    let ball = Blob::sphere(Vec3::ZERO, 1.0);
    let at = [Vec3::Y * 3.0, Vec3::NEG_Y * 3.0, Vec3::X * 1e-3];
    let lamp = |height: f32| BlobLight::new(HomogeneousLight::point(Vec3::Y * height), 0.1, REACH);
    for height in [1.01, 0.99, 0.3] {
        let seen = ask(&gpu, lamp(height), &[ball], &at);
        assert!(seen[0] == 1.0 && seen[1] < 1e-5, "{height}: {seen:?}");
    }
    // Exactly in the middle, and at the receiver: a number between 0 and 1 all the same.
    let seen = ask(&gpu, lamp(0.0), &[ball], &[at[0], at[1], at[2], Vec3::ZERO]);
    assert!(seen.iter().all(|v| (0.0..=1.0).contains(v)), "{seen:?}");
    // A blob beyond the light shadows nothing.
    let beyond = Blob::sphere(Vec3::Y * 9.0, 1.0);
    assert_eq!(ask(&gpu, lamp(5.0), &[beyond], &at[..1]), [1.0]);
    assert!(ask(&gpu, lamp(12.0), &[beyond], &at[..1])[0] < 0.01);
}

#[test]
fn shadows_are_multiplied_faded_and_left_out_as_asked() {
    let Some(gpu) = Gpu::for_test() else { return };
    let sun = |reach| BlobLight::new(DirectionalLight::new(Vec3::Y), 0.1, reach);
    let blob = |opacity| Blob {
        opacity,
        ..Blob::sphere(Vec3::Y * 2.0, 1.0)
    };
    let below = Vec3::ZERO;
    let near = |seen: &[f32], expected: f32| assert!((seen[0] - expected).abs() < 1e-5, "{seen:?}");
    near(&ask(&gpu, sun(REACH), &[blob(0.25)], &[below]), 0.75);
    let both = ask(&gpu, sun(REACH), &[blob(0.5), blob(0.5)], &[below]);
    near(&both, 0.25);
    // 1 from the sphere around it: whole up to 3/4 of the reach.
    for (reach, expected) in [(1.34, 0.0), (1.0, 1.0), (8.0 / 7.0, 0.5)] {
        let faded = ask(&gpu, sun(reach), &[blob(1.0)], &[below]);
        assert!((faded[0] - expected).abs() < 1e-3, "{reach}: {faded:?}");
    }
    let lights = [sun(REACH)];
    let frame = BlobFrame {
        lights: &lights,
        blobs: &[blob(0.5), blob(0.25)],
        ..Default::default()
    };
    let questions = [0, 1, 2].map(|own| Question {
        own,
        ..Question::of(below, 0)
    });
    let seen = answers(&gpu, &frame, &questions);
    for (seen, expected) in seen.into_iter().zip([0.75, 0.5, 0.375]) {
        near(&[seen], expected);
    }
    // A light that the frame has not.
    assert_eq!(answers(&gpu, &frame, &[Question::of(below, 1)]), [1.0]);
}
