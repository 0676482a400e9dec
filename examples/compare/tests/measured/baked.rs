//! Light maps: right where texels allow it, and better with more of them.

use compare::shadow::Shadow;
use compare::stage::Stage;
use compare::survey::{Bake, Baked, Survey};
use compare::technique::{Config, Technique};
use host::gpu::Gpu;
use host::scene::{Scene, floor, moved_light, spheres};
use shadows::glam::Vec3;
use shadows::reference::ReferenceImage;

struct Baking<'a> {
    gpu: &'a Gpu,
    stage: Stage,
    reference: ReferenceImage,
}

impl<'a> Baking<'a> {
    fn new(gpu: &'a Gpu, scene: Scene) -> Self {
        let stage = Stage::new(gpu, scene, [320, 180]).unwrap();
        let reference = stage.reference(|_| ()).unwrap();
        Self {
            gpu,
            stage,
            reference,
        }
    }

    /// Pixels whose visibility is wrong by more than a tenth, interior and all, and what it took.
    fn wrong(&self, baked: Baked) -> ([usize; 2], Bake) {
        let technique = Technique {
            name: "baked".into(),
            config: Config::Survey(Survey::Baked(baked)),
        };
        let stage = &self.stage;
        let mut shadow = Shadow::new(self.gpu, &stage.renderer, technique).unwrap();
        let picture = stage.picture(self.gpu, &mut shadow, &stage.inputs);
        let shown = picture.unwrap().visibility;
        let pixels = shown.iter().zip(self.reference.visibility());
        let judged = |(shown, truth): (&u8, u8)| match shown.abs_diff(truth) > 25 {
            true => 255 - truth,
            false => truth,
        };
        let judged: Vec<u8> = pixels.map(judged).collect();
        let error = self.reference.compare(&judged, shadow.interior()).unwrap();
        let interior = error.false_lit_interior + error.false_shadow_interior;
        let all = error.false_lit + error.false_shadow;
        ([interior, all], shadow.bake().unwrap())
    }
}

#[test]
fn twice_the_texels_leave_about_half_of_the_wrong_pixels() {
    let Some(gpu) = Gpu::for_test() else { return };
    let floor = Baking::new(&gpu, floor());
    let mut before: Option<usize> = None;
    for texels in [128, 256, 512] {
        let ([interior, all], bake) = floor.wrong(Baked::new(texels, 4, 0.0));
        println!(
            "{texels}: {all}, texel {:.4}, {:.1} s",
            bake.texel, bake.seconds
        );
        assert_eq!(interior, 0, "{texels}");
        if let Some(before) = before {
            let part = all as f64 / before as f64;
            assert!((0.3..0.7).contains(&part), "{texels}: {part}");
        }
        before = Some(all);
    }
}

/// Without gaps a filter reads what is on the other side of a seam.
#[test]
fn seams_are_right_for_their_gaps_alone() {
    let Some(gpu) = Gpu::for_test() else { return };
    let spheres = Baking::new(&gpu, spheres());
    let baked = Baked::new(512, 4, 0.0);
    let ([right, _], _) = spheres.wrong(baked);
    let ([wrong, _], _) = spheres.wrong(Baked { gap: 0, ..baked });
    println!("{right} {wrong}");
    assert_eq!(right, 0);
    assert!(wrong > 50, "{wrong}");
}

/// A light that has moved is baked anew; one that stands is not.
#[test]
fn a_map_is_of_one_light() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut floor = Baking::new(&gpu, floor());
    let config = Config::Survey(Survey::Baked(Baked::new(128, 1, 0.0)));
    let technique = Technique {
        name: "baked".into(),
        config,
    };
    let mut shadow = Shadow::new(&gpu, &floor.stage.renderer, technique).unwrap();
    let mut shown = |stage: &Stage| {
        let picture = stage.picture(&gpu, &mut shadow, &stage.inputs).unwrap();
        (picture.visibility, shadow.bake().unwrap())
    };
    let first = shown(&floor.stage);
    assert_eq!(first, shown(&floor.stage));
    let light = floor.stage.inputs.light;
    floor.stage.inputs.light = moved_light(light, Vec3::X);
    assert_ne!(first, shown(&floor.stage));
}
