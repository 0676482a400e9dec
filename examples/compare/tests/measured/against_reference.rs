//! Whole scenes on the driver against exact ray casting: the promises of the README, and for each of
//! them something broken that must not keep it.

use shadows::Bias;
use shadows::glam::{Vec3, Vec4};
use shadows::reference::{Comparison, ReferenceImage};

use compare::shadow::{Shadow, ShadowInputs};
use compare::stage::Stage;
use compare::technique::{Config, Technique};
use host::gpu::Gpu;
use host::scene::{LightKind, Scene, moved_light};

const SIZE: [u32; 2] = [1280, 720];
const FACE: u32 = 1024;
const CUBE: &str = "cube-2x2";

/// A scene on the GPU with its exact answer.
struct Studio {
    gpu: Gpu,
    stage: Stage,
    reference: ReferenceImage,
}

impl Studio {
    /// `None` where there is no driver.
    fn new(scene: Scene) -> Option<Self> {
        let gpu = Gpu::for_test()?;
        let stage = Stage::new(&gpu, scene, SIZE).unwrap();
        let reference = stage.reference(|_| ()).unwrap();
        Some(Self {
            gpu,
            stage,
            reference,
        })
    }

    /// The error of a technique that is told what `falsify` makes of the truth.
    fn error(
        &self,
        technique: &str,
        bias: Bias,
        falsify: impl FnOnce(&mut ShadowInputs),
    ) -> Comparison {
        self.error_at(FACE, technique, bias, falsify)
    }

    /// The same with another size of cube faces.
    fn error_at(
        &self,
        face: u32,
        technique: &str,
        bias: Bias,
        falsify: impl FnOnce(&mut ShadowInputs),
    ) -> Comparison {
        let (gpu, stage) = (&self.gpu, &self.stage);
        let mut inputs = stage.inputs.clone();
        falsify(&mut inputs);
        let row = compare::table::ROWS
            .iter()
            .find(|row| row.name == technique);
        let technique = with_bias(row.unwrap().at(face), bias);
        let picture = gpu.checked(|| {
            let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone()).unwrap();
            let picture = stage.picture(gpu, &mut shadow, &inputs).unwrap();
            (picture, shadow.interior())
        });
        self.reference
            .compare(&picture.0.visibility, picture.1)
            .unwrap()
    }

    fn true_error(&self, technique: &str) -> Comparison {
        self.error(technique, Bias::default(), |_| ())
    }
}

/// Techniques whose map has another default, such as the textbook's, keep it.
fn with_bias(mut technique: Technique, bias: Bias) -> Technique {
    match &mut technique.config {
        Config::Cube { map, .. } if bias != Bias::default() => map.settings.bias = bias,
        Config::Flat { map, .. } => map.settings.bias = bias,
        _ => {}
    }
    technique
}

fn interior(error: &Comparison) -> usize {
    error.false_lit_interior + error.false_shadow_interior
}

fn wrong_percent(error: &Comparison) -> f64 {
    100.0 * (error.false_lit + error.false_shadow) as f64 / error.lit_facing as f64
}

/// The technique believes the light to be 5 cm from where it is.
fn move_light(inputs: &mut ShadowInputs) {
    inputs.light = moved_light(inputs.light, Vec3::new(0.03, 0.0, 0.04));
}

/// Every second caster is forgotten, the first of them included.
fn forget_casters(inputs: &mut ShadowInputs) {
    let mut keep = true;
    inputs.casters.retain(|_| {
        keep = !keep;
        keep
    });
}

/// No interior error, and each broken twin has some.
fn volumes_are_exact(studio: &Studio) -> Comparison {
    let error = studio.true_error("volume");
    assert!(
        error.lit_facing > 100_000,
        "{} pixels count",
        error.lit_facing
    );
    assert_eq!(interior(&error), 0, "interior errors");
    for (what, falsify) in [
        ("a moved light", move_light as fn(&mut ShadowInputs)),
        ("forgotten casters", forget_casters),
    ] {
        let broken = studio.error("volume", Bias::default(), falsify);
        assert!(interior(&broken) > 0, "{what} went unnoticed");
        assert!(wrong_percent(&broken) > wrong_percent(&error), "{what}");
    }
    // However silhouettes are found, and whatever is drawn of volumes.
    let rows = compare::table::ROWS
        .iter()
        .filter(|row| row.name.starts_with("volume-"));
    let mut seen = 0;
    for row in rows {
        let counts = row.name == "volume-exact-count";
        if counts && !studio.gpu.support.float32_blending {
            continue;
        }
        assert_eq!(interior(&studio.true_error(row.name)), 0, "{}", row.name);
        seen += 1;
    }
    assert!(seen > 5, "{seen} rows");
    error
}

#[test]
fn volumes_are_exact_to_the_pixel_on_the_spheres() {
    let Some(studio) = Studio::new(host::scene::spheres()) else {
        return;
    };
    let error = volumes_are_exact(&studio);
    let wrong = wrong_percent(&error);
    assert!(wrong <= 0.011, "{wrong} % of pixels are wrong");
    let moved = studio.error("volume", Bias::default(), move_light);
    assert!(
        wrong_percent(&moved) > 0.011,
        "a moved light keeps the limit"
    );
}

#[test]
fn volumes_are_exact_in_the_courtyard() {
    if let Some(studio) = Studio::new(host::scene::courtyard()) {
        volumes_are_exact(&studio);
    }
}

#[test]
fn volumes_are_exact_on_the_open_teapot() {
    if let Some(studio) = Studio::new(host::scene::teapot()) {
        volumes_are_exact(&studio);
    }
}

#[test]
fn a_bilinear_cube_map_is_wrong_only_at_edges_on_the_spheres() {
    // A quarter more than exact depths at the texel centres and no bias at all would give.
    const LIMIT: f64 = 0.18;
    let Some(studio) = Studio::new(host::scene::spheres()) else {
        return;
    };
    for (face, limit) in [(512, 0.36), (FACE, LIMIT), (2048, 0.09)] {
        let error = studio.error_at(face, CUBE, Bias::default(), |_| ());
        let wrong = wrong_percent(&error);
        eprintln!("{face} texels a face: {wrong} %");
        assert_eq!(interior(&error), 0, "interior errors at {face}");
        assert!(wrong <= limit, "{wrong} % of pixels are wrong at {face}");
    }
    // What textbooks do with the same texels.
    let textbook = wrong_percent(&studio.true_error("cube-textbook"));
    eprintln!("textbook: {textbook} %");
    assert!(
        textbook > wrong_percent(&studio.true_error(CUBE)),
        "{textbook}"
    );

    for (what, bias, falsify) in [
        ("a moved light", Bias::default(), move_light as fn(&mut _)),
        ("forgotten casters", Bias::default(), forget_casters),
        ("no bias", Bias::NONE, |_: &mut ShadowInputs| ()),
    ] {
        let broken = studio.error(CUBE, bias, falsify);
        let wrong = wrong_percent(&broken);
        assert!(
            interior(&broken) > 0 || wrong > LIMIT,
            "{what} went unnoticed: {wrong} %"
        );
    }
}

/// The same for a light far away, or seen by texels that are larger.
fn move_light_far(inputs: &mut ShadowInputs) {
    inputs.light = moved_light(inputs.light, Vec3::new(0.09, 0.0, 0.12));
}

/// A 2x2 flat map on the spheres, lit by another kind of light; and each broken twin.
fn a_flat_map_is_wrong_only_at_edges(kind: LightKind, limit: f64) {
    let mut scene = host::scene::spheres();
    scene.light_mut().place += Vec4::new(1.3, 3.0, 0.9, 0.0);
    scene.shine_as(kind).unwrap();
    let Some(studio) = Studio::new(scene) else {
        return;
    };
    let error = studio.true_error("flat-2x2");
    let wrong = wrong_percent(&error);
    eprintln!("{kind:?}: {wrong} % of {} pixels", error.lit_facing);
    assert!(error.lit_facing > 100_000, "{}", error.lit_facing);
    assert_eq!(interior(&error), 0, "interior errors, {kind:?}");
    assert!(wrong <= limit, "{wrong} % of pixels are wrong, {kind:?}");
    for (what, bias, falsify) in [
        (
            "a moved light",
            Bias::default(),
            move_light_far as fn(&mut _),
        ),
        ("forgotten casters", Bias::default(), forget_casters),
        ("no bias", Bias::NONE, |_: &mut ShadowInputs| ()),
    ] {
        let broken = studio.error("flat-2x2", bias, falsify);
        let wrong = wrong_percent(&broken);
        assert!(
            interior(&broken) > 0 || wrong > limit,
            "{what} went unnoticed: {wrong} %, {kind:?}"
        );
    }
    // Volumes are exact for any light.
    assert_eq!(interior(&studio.true_error("volume")), 0, "{kind:?}");
}

#[test]
fn a_flat_map_of_a_spot_is_wrong_only_at_edges() {
    a_flat_map_is_wrong_only_at_edges(LightKind::Spot, 0.09);
}

#[test]
fn a_flat_map_of_a_directional_light_is_wrong_only_at_edges() {
    a_flat_map_is_wrong_only_at_edges(LightKind::Directional, 0.13);
}
