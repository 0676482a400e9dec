//! A sun's cascades over the valley: what they gain over one map of as many texels, and what they need for it.

use compare::shadow::Shadow;
use compare::stage::Stage;
use compare::table::ROWS;
use host::gpu::Gpu;
use host::scene;
use shadows::reference::{Comparison, ReferenceImage};

const SIZE: [u32; 2] = [320, 180];

/// Wrong pixels of a technique, as a part of those that face the light.
fn wrong(error: &Comparison) -> f64 {
    (error.false_lit + error.false_shadow) as f64 / error.lit_facing as f64
}

fn error(
    gpu: &Gpu,
    stage: &Stage,
    truth: &ReferenceImage,
    (name, side): (&str, u32),
    are_depths_known: bool,
) -> Comparison {
    let row = ROWS.iter().find(|row| row.name == name).unwrap();
    let mut inputs = stage.inputs.clone();
    if !are_depths_known {
        inputs.depth_bounds = None;
    }
    gpu.checked(|| {
        let mut shadow = Shadow::new(gpu, &stage.renderer, row.at(side)).unwrap();
        let picture = stage.picture(gpu, &mut shadow, &inputs).unwrap();
        truth
            .compare(&picture.visibility, shadow.interior())
            .unwrap()
    })
}

#[test]
fn four_cascades_leave_a_third_of_the_wrong_pixels_of_one_map_of_as_many_texels() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu, scene::valley(), SIZE).unwrap();
    let truth = stage.reference(|_| ()).unwrap();
    let of = |technique, known| error(&gpu, &stage, &truth, technique, known);
    let flat = wrong(&of(("flat-2x2", 2048), true));
    let part = |name, known| {
        let found = of((name, 1024), known);
        let interior = found.false_lit_interior + found.false_shadow_interior;
        assert_eq!(interior, 0, "{name}");
        wrong(&found) / flat
    };
    let tight = part("atlas-tight-2x2", true);
    let stable = part("atlas-2x2", true);
    assert!(tight < 0.42, "{tight} of {flat}");
    assert!(stable < 0.62, "{stable} of {flat}");
    // The broken twins: cascades that do not know what is seen.
    let unknown = [part("atlas-tight-2x2", false), part("atlas-2x2", false)];
    assert!(unknown[0] > 0.55 && unknown[1] > 0.7, "{unknown:?}");
}

#[test]
fn the_hosts_depth_buffer_says_what_the_reference_sees() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu, scene::valley(), SIZE).unwrap();
    let truth = stage.reference(|_| ()).unwrap();
    let camera = &stage.scene.camera;
    let axis = (camera.target - camera.eye).as_dvec3().normalize();
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let depths = pixels.filter_map(|(x, y)| truth.hit(x, y));
    let depths: Vec<f64> = depths
        .map(|hit| axis.dot(hit.position - camera.eye.as_dvec3()))
        .collect();
    let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let farthest = depths.iter().copied().fold(0.0, f64::max);
    let bounds = stage.inputs.depth_bounds.unwrap();
    let [near, far] = [bounds.nearest, bounds.farthest].map(f64::from);
    assert!((0.99..=1.0).contains(&(near / nearest)), "{near} {nearest}");
    assert!((1.0..1.02).contains(&(far / farthest)), "{far} {farthest}");
}
