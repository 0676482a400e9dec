//! Several views in one pass: each layer is to the bit what a pass of that view alone comes to.

use shadows::glam::{Affine3A, Vec3};
use shadows::{
    CasterState, Counter, HomogeneousLight, Method, ShadowVolumeRenderer, VolumeLight, wgpu,
};

use crate::choices::depths;
use crate::layers::{Pass, assert_same, gpu_that_clips, gpu_with, layer_of, read};
use crate::passes::{HostPipelines, LightPass, attach, begin, clear, view_of};
use crate::pictures::{at, lamp, mixed, sun};
use crate::shapes;
use crate::stage::{Body, SIDE, Savings, Stage, WAYS};
use host::gpu::Gpu;

const FORMATS: [wgpu::TextureFormat; 2] = [
    wgpu::TextureFormat::Depth32FloatStencil8,
    wgpu::TextureFormat::Depth24PlusStencil8,
];
const NONE: wgpu::Features = wgpu::Features::empty();

/// A scene seen by several cameras: eye and target each.
fn seen(scene: &Stage, cameras: [[Vec3; 2]; 3]) -> Vec<Stage> {
    let stage = |[eye, target]: [Vec3; 2]| Stage {
        eye,
        target,
        ..scene.clone()
    };
    cameras.map(stage).to_vec()
}

/// Casters of all kinds, seen from the front, from within the shadow of a ball, and from the side.
pub fn stages(light: HomogeneousLight) -> Vec<Stage> {
    let mut scene = mixed(light);
    let ball = Vec3::new(0.0, 2.4, 0.0);
    let body = Body::caster(shapes::sphere(16), Affine3A::from_translation(ball));
    scene.bodies.push(body);
    let behind_ball = match light.is_directional() {
        true => Vec3::new(0.4, -1.0, -0.3),
        false => Vec3::new(2.0, -3.6, -2.5),
    };
    let in_shadow = ball + 1.4 * behind_ball.normalize();
    let cameras = [
        [scene.eye, scene.target],
        [in_shadow, Vec3::new(-1.5, 0.3, 2.0)],
        [Vec3::new(-7.0, 3.0, 4.0), Vec3::new(0.5, 0.5, 0.0)],
    ];
    seen(&scene, cameras)
}

/// Volumes that lie before the cameras with all their corners, and end where the light's range does. The box of one caster, two cubes, holds what is
/// between the second camera, which sees one on its left and one on its right, and the light.
pub fn uncut() -> Vec<Stage> {
    let cube = |place: Vec3| {
        let mut cube = shapes::cube();
        for position in &mut cube.positions {
            *position = (0.3 * Vec3::from(*position) + place).to_array();
        }
        cube
    };
    let two = cube(Vec3::new(-1.0, 2.0, 4.5)).with(&cube(Vec3::new(2.5, 2.0, 1.0)));
    let light = HomogeneousLight::point(Vec3::new(2.0, 60.0, 4.0));
    let fins = at(0.2, 0.4, 0.2) * Affine3A::from_scale(Vec3::splat(0.6));
    let mut scene = Stage::new(
        light,
        vec![
            Body::caster(two, Affine3A::IDENTITY),
            Body::caster(shapes::fins(3), fins),
            Body::caster(shapes::sphere(9), at(-1.0, 1.3, 1.0)),
        ],
    );
    scene.range = Some(61.0);
    let cameras = [
        [Vec3::new(2.5, 5.0, 12.0), Vec3::new(0.0, 0.5, 2.0)],
        [Vec3::new(2.0, 1.2, 4.0), Vec3::new(-2.0, 0.4, 0.0)],
        [Vec3::new(-9.0, 4.0, 7.0), Vec3::new(0.0, 0.5, 2.5)],
    ];
    let mut stages = seen(&scene, cameras);
    stages[1].field_of_view = 2.3;
    stages
}

pub fn with(stages: &[Stage], change: impl Fn(&mut Stage)) -> Vec<Stage> {
    let mut stages = stages.to_vec();
    stages.iter_mut().for_each(change);
    stages
}

/// What a pass of each view alone counts.
pub fn alone(gpu: &Gpu, stages: &[Stage]) -> Vec<Vec<u8>> {
    stages.iter().map(|stage| stage.counts(gpu)).collect()
}

/// What becomes of each caster in each view alone.
fn states(gpu: &Gpu, stages: &[Stage]) -> Vec<Vec<CasterState>> {
    let of = |stage: &Stage| {
        let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
        stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
        renderer.caster_states(0, 0)
    };
    stages.iter().map(of).collect()
}

fn is_shown(counts: &[u8]) -> bool {
    counts.iter().filter(|&&count| count > 0).count() > 300
}

/// In every format, by every way of finding silhouettes, two views and three.
fn assert_layers_as_alone(gpu: &Gpu, stages: &[Stage]) {
    for format in FORMATS {
        for silhouettes in WAYS {
            let stages = with(stages, |stage| {
                (stage.format, stage.savings.silhouettes) = (format, silhouettes);
            });
            let what = format!("{:?}, {format:?}, {silhouettes:?}", stages[0].light);
            let right = alone(gpu, &stages);
            assert!(right.iter().all(|counts| is_shown(counts)), "{what}");
            assert_same(&Pass::new(gpu, 0b111, &stages).counts(), &right, &what);
            let mut two = Pass::new(gpu, 0b11, &stages[..2]);
            assert_same(&two.counts(), &right[..2], &what);
            // As if every layer were drawn with the first view's camera.
            let mut renderer = two.renderer();
            let second = std::mem::replace(&mut two.stages[1], stages[0].clone());
            two.prepare(&mut renderer, &[two.light()]);
            two.stages[1] = second;
            let blind = two.counts_of(&mut renderer, |renderer, pass| {
                renderer.render(pass, 0, 0).unwrap();
            });
            assert!(blind[0] == right[0] && blind[1] != right[1], "{what}");
        }
    }
}

#[test]
fn each_layer_counts_as_its_view_alone() {
    let Some(gpu) = gpu_with(NONE) else { return };
    let stages = uncut();
    let states = states(&gpu, &stages);
    let [outside, between, _] = &states[..] else {
        panic!("three views");
    };
    assert!(outside.iter().all(|state| *state == CasterState::ZPass));
    assert_eq!(between[0], CasterState::ZFail);
    assert_layers_as_alone(&gpu, &stages);
}

#[test]
fn each_layer_counts_as_its_view_alone_from_within_a_shadow() {
    let Some(gpu) = gpu_that_clips(NONE) else {
        return;
    };
    for light in [lamp(), sun()] {
        assert_layers_as_alone(&gpu, &stages(light));
    }
}

#[test]
fn what_one_view_must_count_behind_is_counted_so_in_all() {
    let Some(gpu) = gpu_that_clips(NONE) else {
        return;
    };
    for light in [lamp(), sun()] {
        let stages = stages(light);
        let states = states(&gpu, &stages);
        let [outside, within, _] = &states[..] else {
            panic!("three views");
        };
        // The ball is the last.
        assert!(outside.iter().all(|state| *state == CasterState::ZPass));
        assert_eq!(within.last(), Some(&CasterState::ZFail));
        let right = alone(&gpu, &stages);
        let pass = Pass::new(&gpu, 0b11, &stages[..2]);
        let mut renderer = pass.renderer();
        pass.prepare(&mut renderer, &[light.into()]);
        let together = renderer.caster_states(0, 0);
        assert_eq!(together.last(), Some(&CasterState::ZFail));
        assert!(together.contains(&CasterState::ZPass), "{together:?}");
        assert_same(&pass.counts(), &right[..2], "both");
        // As if the first view decided for both.
        let of_first = with(&stages, |stage| stage.savings.method = Method::ZPass);
        let wrong = Pass::new(&gpu, 0b11, &of_first[..2]).counts();
        assert!(wrong[0] == right[0] && wrong[1] != right[1]);
    }
}

/// A shadow is a count that is not 0.
fn shadows(layers: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let of = |counts: &Vec<u8>| counts.iter().map(|&count| u8::from(count != 0)).collect();
    layers.iter().map(of).collect()
}

#[test]
fn a_view_from_within_a_caster_does_not_harm_the_others() {
    let Some(gpu) = gpu_that_clips(NONE) else {
        return;
    };
    for silhouettes in WAYS {
        let mut stages = with(&stages(lamp()), |stage| {
            stage.savings.silhouettes = silhouettes;
        });
        stages[2].eye = Vec3::new(0.0, 2.4, 0.2);
        let right = shadows(&alone(&gpu, &stages));
        let found = shadows(&Pass::new(&gpu, 0b111, &stages).counts());
        // There every triangle counts, so that counts differ, but not what is in shadow.
        assert_same(&found, &right, &format!("{silhouettes:?}"));
    }
}

#[test]
fn every_depth_convention_range_and_end_is_right_in_every_layer() {
    let Some(gpu) = gpu_that_clips(NONE) else {
        return;
    };
    for depth in depths(&gpu) {
        for (what, range, receivers) in [
            ("without an end", None, false),
            ("range", Some(14.0), false),
            ("receivers", None, true),
        ] {
            // How far behind is what the farthest eye's floats ask for, and where depth rounds by much a
            // pixel may show it.
            if receivers && depth.clips_far() {
                continue;
            }
            let stages = with(&stages(lamp()), |stage| {
                (stage.depth, stage.range) = (depth, range);
                stage.receivers = receivers.then(|| Stage::bounds(&stage.bodies));
            });
            let right = alone(&gpu, &stages);
            let found = Pass::new(&gpu, 0b111, &stages).counts();
            assert_same(&found, &right, &format!("{depth:?}, {what}"));
        }
    }
}

#[test]
fn a_mask_may_have_gaps_and_leaves_them_alone() {
    let Some(gpu) = gpu_with(wgpu::Features::SELECTIVE_MULTIVIEW) else {
        return;
    };
    let stages = uncut();
    let each = alone(&gpu, &stages);
    let [first, second, _] = &each[..] else {
        panic!("three views");
    };
    let none = vec![0; first.len()];
    for (mask, right) in [
        (0b101, [first, &none, second]),
        (0b110, [&none, first, second]),
    ] {
        let found = Pass::new(&gpu, mask, &stages[..2]).counts();
        assert_same(&found, &right.map(Vec::clone), &format!("{mask:#b}"));
    }
}

#[test]
fn one_frame_has_the_views_of_several_passes() {
    let Some(gpu) = gpu_with(NONE) else { return };
    let mut stages = uncut();
    stages.push(stages[0].clone());
    stages[3].eye += Vec3::new(0.5, 0.0, 0.2);
    let right = alone(&gpu, &stages);
    let mut all = Pass::new(&gpu, 0b11, &stages);
    let mut renderer = all.renderer();
    all.prepare(&mut renderer, &[all.light()]);
    let counts = |renderer: &mut ShadowVolumeRenderer, place: usize, stages: &[Stage]| {
        Pass::new(&gpu, 0b11, stages).counts_of(renderer, |renderer, pass| {
            renderer.render(pass, 0, place).unwrap();
        })
    };
    for place in [0, 1] {
        let own = 2 * place..2 * place + 2;
        let found = counts(&mut renderer, place, &stages[own.clone()]);
        assert_same(&found, &right[own], &format!("{place}"));
    }
    all.prepare(&mut renderer, &[all.light()]);
    assert_eq!(renderer.statistics().uploaded, 0, "nothing moved");
    all.stages[3].eye.x += 0.4;
    all.prepare(&mut renderer, &[all.light()]);
    assert!(renderer.statistics().uploaded > 0);
    assert_eq!(renderer.statistics().casters_extracted, 0);
    let found = counts(&mut renderer, 1, &all.stages[2..]);
    assert_same(&found, &alone(&gpu, &all.stages[2..]), "moved");
    assert!(found[1] != right[3]);
}

#[test]
fn a_reset_makes_room_for_the_next_light_in_every_layer() {
    // Its triangle reaches beyond the screen.
    let Some(gpu) = gpu_that_clips(NONE) else {
        return;
    };
    let other = HomogeneousLight::point(Vec3::new(-4.0, 60.0, -1.0));
    let stages = uncut();
    let right = alone(&gpu, &with(&stages, |stage| stage.light = other));
    let pass = Pass::new(&gpu, 0b111, &stages);
    let mut renderer = pass.renderer();
    let second = VolumeLight::new(other, stages[0].range);
    pass.prepare(&mut renderer, &[pass.light(), second]);
    let mut both = |reset: bool| {
        pass.counts_of(&mut renderer, |volumes, pass| {
            volumes.render(pass, 0, 0).unwrap();
            if reset {
                volumes.reset(pass);
            }
            volumes.render(pass, 1, 0).unwrap();
        })
    };
    assert_same(&both(true), &right, "reset");
    assert!(both(false) != right);
}

#[test]
fn exact_counts_are_those_of_each_view_and_need_no_stencil() {
    let Some(gpu) = gpu_with(wgpu::Features::FLOAT32_BLENDABLE) else {
        return;
    };
    for format in [FORMATS[0], wgpu::TextureFormat::Depth32Float] {
        for silhouettes in WAYS {
            let stages = with(&uncut(), |stage| {
                stage.format = format;
                stage.savings = Savings {
                    silhouettes,
                    counter: Counter::Exact,
                    ..Default::default()
                };
            });
            let pass = Pass::new(&gpu, 0b111, &stages);
            let depth = pass.target(format, 1);
            let counts = pass.target(wgpu::TextureFormat::R32Float, 1);
            let mut renderer = pass.renderer();
            pass.prepare(&mut renderer, &[pass.light()]);
            pass.record(&mut renderer, &depth, Some(&counts), |volumes, pass| {
                volumes.render(pass, 0, 0).unwrap();
            });
            let right: Vec<_> = stages
                .iter()
                .map(|stage| exact_counts(&gpu, stage))
                .collect();
            let found = read(&gpu, &counts, wgpu::TextureAspect::All);
            assert_same(&found, &right, &format!("{format:?}, {silhouettes:?}"));
        }
    }
}

fn exact_counts(gpu: &Gpu, stage: &Stage) -> Vec<u8> {
    let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &stage.descriptor()).unwrap();
    stage.prepare(gpu, &mut renderer, &stage.casters(gpu));
    let depth = view_of(&gpu.target([SIDE; 2], stage.format, 1));
    let (counts, host) = (stage.exact_count(gpu), HostPipelines::new(gpu, stage));
    let surfaces = stage.surfaces(gpu);
    gpu.checked(|| {
        gpu.run(|encoder| {
            renderer.encode(encoder);
            stage.prepass(encoder, &depth, &host, &surfaces);
            let mut pass = counts.begin(encoder, &depth).unwrap();
            renderer.render(&mut pass, 0, 0).unwrap();
        });
    });
    gpu.read_texture(counts.texture(), 0, wgpu::TextureAspect::All)
}

#[test]
fn with_four_samples_each_layer_is_lit_as_its_view_alone() {
    let Some(gpu) = gpu_with(wgpu::Features::MULTISAMPLE_ARRAY) else {
        return;
    };
    let stages = with(&uncut(), |stage| stage.samples = 4);
    let pass = Pass::new(&gpu, 0b111, &stages);
    let depth = pass.target(stages[0].format, 4);
    let mut renderer = pass.renderer();
    pass.prepare(&mut renderer, &[pass.light()]);
    pass.record(&mut renderer, &depth, None, |volumes, pass| {
        volumes.render(pass, 0, 0).unwrap();
    });
    let format = wgpu::TextureFormat::R8Unorm;
    let lit = |(layer, stage): (u32, &Stage)| {
        let color = view_of(&gpu.target([SIDE; 2], format, 4));
        let picture = gpu.target([SIDE; 2], format, 1);
        let (host, surfaces) = (HostPipelines::new(&gpu, stage), stage.surfaces(&gpu));
        gpu.checked(|| {
            gpu.run(|encoder| {
                let (resolved, depth) = (view_of(&picture), layer_of(&depth, layer));
                let target = clear(&color, wgpu::Color::BLACK, Some(&resolved));
                let mut pass = begin(encoder, "light", &[Some(target)], attach(&depth, None));
                pass.set_stencil_reference(0);
                LightPass::Screen.draw(&mut pass, &host, &surfaces);
            });
        });
        gpu.read_texture(&picture, 0, wgpu::TextureAspect::All)
    };
    let found: Vec<_> = (0..).zip(&stages).map(lit).collect();
    let right: Vec<_> = stages.iter().map(|stage| stage.draw(&gpu)).collect();
    assert_same(&found, &right, "four samples");
    assert!(right[0].iter().any(|value| (1..255).contains(value)));
}
