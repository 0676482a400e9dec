//! The sun's cascades as `compare` asks for them: told between which depths its picture shows anything.

use compare::shadow::{Shadow, ShadowInputs};
use compare::stage::Stage;
use compare::table::ROWS;
use host::gpu::Gpu;
use host::renderer::{Look, Orthographic};
use host::scene::{Camera, Scene};
use shadows::DepthConvention;
use shadows::reference::{Interior, ReferenceImage};

const SIZE: [u32; 2] = [160, 90];

fn valley(name: &str) -> Scene {
    host::scene::load(name, false, None).unwrap()
}

/// The least and the greatest depth that exact rays find, along the camera's axis from a distance on.
fn exact(truth: &ReferenceImage, camera: &Camera, from: f64) -> [f64; 2] {
    let eye = camera.eye.as_dvec3();
    let axis = (camera.target - camera.eye).as_dvec3().normalize();
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    let hits = pixels.filter_map(|(x, y)| truth.hit(x, y));
    let depths = hits.map(|hit| axis.dot(hit.position - eye) - from);
    depths.fold([f64::INFINITY, 0.0], |[least, greatest], depth| {
        [depth.min(least), depth.max(greatest)]
    })
}

#[test]
fn the_hosts_depth_buffer_says_between_which_depths_something_is_seen() {
    let Some(gpu) = Gpu::for_test() else { return };
    let near = -3.0;
    let orthographic = Some(Orthographic {
        left: -20.0,
        right: 20.0,
        bottom: -11.0,
        top: 11.0,
        near,
        far: 2000.0,
    });
    let mut seen = Vec::new();
    for (depth, orthographic) in [
        (DepthConvention::InfiniteReverse, None),
        (DepthConvention::FiniteReverse, None),
        (DepthConvention::Standard, None),
        (DepthConvention::Standard, orthographic),
        (DepthConvention::FiniteReverse, orthographic),
    ] {
        let look = Look {
            depth,
            orthographic,
            ..Look::default()
        };
        let stage = Stage::with_look(&gpu, valley("valley"), SIZE, look).unwrap();
        let truth = stage.reference(|_| ()).unwrap();
        let from = orthographic.map_or(0.0, |_| f64::from(near));
        let [least, greatest] = exact(&truth, &stage.scene.camera, from);
        let found = stage.inputs.depths.unwrap();
        let [nearest, farthest] = [found.nearest, found.farthest].map(f64::from);
        let what = format!("{look:?}: {found:?}, exactly {least} to {greatest}");
        assert!(nearest <= least && least <= 1.03 * nearest, "{what}");
        assert!(
            farthest >= greatest && greatest >= 0.97 * farthest,
            "{what}"
        );
        seen.push(nearest);
    }
    // Bounds of another camera are others.
    assert!((seen[0] - seen[3]).abs() > 1.0, "{seen:?}");
}

/// Wrong pixels of four cascades of 512 texels, in per cent of those that face the sun.
fn wrong(gpu: &Gpu, stage: &Stage, truth: &ReferenceImage, inputs: &ShadowInputs) -> f64 {
    let row = ROWS.iter().find(|row| row.name == "atlas-2x2").unwrap();
    let mut shadow = Shadow::new(gpu, &stage.renderer, row.at(512)).unwrap();
    let picture = stage.picture(gpu, &mut shadow, inputs).unwrap();
    let found = truth.compare(&picture.visibility, Interior::Screen);
    let found = found.unwrap();
    100.0 * (found.false_lit + found.false_shadow) as f64 / found.lit_facing as f64
}

#[test]
fn cascades_that_know_what_is_seen_have_two_thirds_of_the_wrong_pixels() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu, valley("valley"), SIZE).unwrap();
    let truth = stage.reference(|_| ()).unwrap();
    let told = wrong(&gpu, &stage, &truth, &stage.inputs);
    let inputs = ShadowInputs {
        depths: None,
        ..stage.inputs.clone()
    };
    let not_told = wrong(&gpu, &stage, &truth, &inputs);
    assert!(told < 0.67 * not_told, "{told:.2} %, else {not_told:.2} %");
}

#[test]
fn leaves_that_the_host_draws_cast_in_the_valley() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu, valley("valley-leaves"), SIZE).unwrap();
    assert!(stage.inputs.masked.len() > 50);
    let truth = stage.reference(|_| ()).unwrap();
    let drawn = wrong(&gpu, &stage, &truth, &stage.inputs);
    let inputs = ShadowInputs {
        masked: Vec::new(),
        ..stage.inputs.clone()
    };
    let not_drawn = wrong(&gpu, &stage, &truth, &inputs);
    assert!(
        drawn + 1.0 < not_drawn,
        "{drawn:.2} %, else {not_drawn:.2} %"
    );
}
