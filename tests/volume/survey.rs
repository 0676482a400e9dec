//! The survey counts what is drawn and estimates what it fills.

use shadows::glam::Vec3;
use shadows::{Caps, HomogeneousLight, Method, ShadowVolumeRenderer, Silhouettes, VolumeSurvey};

use crate::debug_views::{layers, nested};
use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, Stage, WAYS};
use host::gpu::Gpu;

fn survey(gpu: &Gpu, stage: &Stage) -> VolumeSurvey {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    renderer.survey(0, 0, [stage.side; 2]).unwrap()
}

fn one_box(light: HomogeneousLight, silhouettes: Silhouettes, method: Method) -> Stage {
    let mut stage = Stage::new(light, vec![Body::caster(shapes::cube(), at(0.0, 2.0, 0.0))]);
    stage.savings.silhouettes = silhouettes;
    stage.savings.method = method;
    stage
}

/// Edges, quads, side triangles, light cap, dark cap.
fn counts(survey: &VolumeSurvey) -> [u64; 5] {
    [
        survey.silhouette_edges,
        survey.side_quads,
        survey.side_triangles,
        survey.light_cap_triangles,
        survey.dark_cap_triangles,
    ]
}

#[test]
fn a_boxs_faces_are_counted() {
    let Some(gpu) = Gpu::for_test() else { return };
    // Three faces of the box are lit by the lamp and by the sun, one by a lamp straight above.
    let above = HomogeneousLight::point(Vec3::new(0.0, 6.0, 0.0));
    for silhouettes in WAYS {
        for (light, method, expected) in [
            (lamp(), Method::ZFail, [6, 6, 0, 6, 6]),
            (lamp(), Method::ZPass, [6, 6, 0, 0, 0]),
            (sun(), Method::ZFail, [6, 0, 6, 6, 0]),
            (above, Method::ZFail, [4, 4, 0, 2, 4]),
        ] {
            let found = survey(&gpu, &one_box(light, silhouettes, method));
            assert_eq!(
                counts(&found),
                expected,
                "{silhouettes:?}, {light:?}, {method:?}"
            );
        }
        let mut full = one_box(lamp(), silhouettes, Method::ZFail);
        full.savings.caps = Caps::Full;
        assert_eq!(counts(&survey(&gpu, &full)), [6, 6, 0, 6, 6]);
        let mut inside = one_box(
            HomogeneousLight::point(Vec3::new(0.1, 2.0, 0.2)),
            silhouettes,
            Method::ZFail,
        );
        inside.range = Some(20.0);
        // From inside every face counts, and no edge is between two that count differently.
        assert_eq!(
            counts(&survey(&gpu, &inside)),
            [0, 0, 0, 12, 12],
            "{silhouettes:?}"
        );
    }
}

#[test]
fn a_box_whose_positions_are_the_hosts_is_taken_for_its_bounds() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut stage = one_box(lamp(), Silhouettes::Compute, Method::ZFail);
    let own = survey(&gpu, &stage);
    stage.host_layout = Some((20, 4));
    let hosts = survey(&gpu, &stage);
    assert_eq!((own.casters_by_bounds, hosts.casters_by_bounds), (0, 1));
    assert_eq!(counts(&own), counts(&hosts));
    assert!((own.fill() / hosts.fill() - 1.0).abs() < 1e-3);
}

/// Pixels covered, by drawing and by estimate.
fn fills(gpu: &Gpu, stage: &Stage) -> (f64, f64) {
    let drawn: u32 = layers(gpu, stage).iter().sum();
    (f64::from(drawn), survey(gpu, stage).fill())
}

#[test]
fn the_estimated_fill_is_what_is_drawn_within_three_percent() {
    let Some(gpu) = Gpu::for_test() else { return };
    let ball = |method| {
        let place = at(0.4, 2.0, 0.0);
        let mut stage = Stage::new(lamp(), vec![Body::caster(shapes::sphere(12), place)]);
        stage.range = Some(6.5);
        stage.savings.method = method;
        stage
    };
    // The volume passes the eye on its way behind it.
    let toward = HomogeneousLight::point(Vec3::new(0.2, 3.0, -4.0));
    let mut passing = Stage {
        eye: Vec3::new(4.0, 1.5, 4.0),
        target: Vec3::new(1.0, 1.5, 0.0),
        field_of_view: 1.6,
        ..one_box(toward, Silhouettes::Auto, Method::ZFail)
    };
    passing.range = Some(20.0);
    let mut cases = vec![
        ball(Method::ZFail),
        ball(Method::ZPass),
        mixed(sun()),
        passing,
    ];
    cases.extend(WAYS.map(|silhouettes| {
        let mut stage = nested(sun());
        stage.savings.silhouettes = silhouettes;
        stage
    }));
    for (case, stage) in cases.iter().enumerate() {
        let (drawn, estimated) = fills(&gpu, stage);
        assert!(drawn > 3000.0 && drawn != 65_536.0, "{case}: {drawn}");
        assert!(
            (estimated / drawn - 1.0).abs() < 0.03,
            "{case}: {drawn} {estimated}"
        );
        // The estimate of another picture is not within that.
        let mut other = stage.clone();
        other.field_of_view *= 0.9;
        let wrong = survey(&gpu, &other).fill();
        assert!(
            (wrong / drawn - 1.0).abs() > 0.03,
            "{case}: {drawn} {wrong}"
        );
    }
}
