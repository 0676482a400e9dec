//! Five hundred random scenes: meshes of both kinds, lights near and inside, eyes inside volumes,
//! fields of view from 20 to 150 degrees, every depth convention and format, 1x and 4x.

use std::collections::HashMap;

use shadows::glam::{Affine3A, Quat, Vec3};
use shadows::{Extrusion, HomogeneousLight, Method, StartFrom, wgpu};

use crate::choices::{TEXTBOOK, depths};
use crate::shapes::{self, Shape};
use crate::stage::{Body, Savings, Stage, WAYS};
use crate::truth::Errors;
use host::gpu::Gpu;
use host::random::Random;

const SCENES: u64 = 500;
const SIDE: u32 = 64;

/// Random casters, out of random numbers.
trait Bodies {
    fn shape(&mut self) -> Shape;
    fn soup(&mut self) -> Shape;
    fn transform(&mut self) -> Affine3A;
}

impl Bodies for Random {
    fn shape(&mut self) -> Shape {
        let rings = 3 + self.below(6) as u32;
        match self.below(8) {
            0 => shapes::cube(),
            1 => shapes::sphere(rings),
            2 => shapes::sphere(rings).reversed(),
            3 => shapes::square(1.0).tilted(),
            4 => shapes::fins(2 + self.below(4) as u32),
            5 => {
                let cut = self.within(-0.5, 0.5);
                shapes::sphere(rings).cut(|corners| corners.iter().all(|c| c.y > cut))
            }
            6 => {
                let step = 2 + self.below(3);
                shapes::sphere(rings).turned(|triangle| triangle % step == 0)
            }
            _ => self.soup(),
        }
    }

    /// Triangles that have nothing to do with one another.
    fn soup(&mut self) -> Shape {
        let mut soup = shapes::square(1.0).cut(|_| false);
        for _ in 0..3 + self.below(8) {
            let first = soup.positions.len() as u32;
            let middle = self.point(0.6);
            let corners = [0; 3].map(|_| (middle + self.point(0.7)).to_array());
            soup.positions.extend(corners);
            soup.indices.extend([first, first + 1, first + 2]);
        }
        soup
    }

    fn transform(&mut self) -> Affine3A {
        let axis = (self.point(1.0) + Vec3::splat(1e-3)).normalize();
        let turn = Quat::from_axis_angle(axis, self.within(0.0, 6.0));
        let mirror = if self.below(4) == 0 { -1.0 } else { 1.0 };
        let size = self.within(0.3, 1.3);
        let stretch = Vec3::new(mirror, self.within(0.4, 1.5), 1.0) * size;
        let place = self.point(2.5) + Vec3::new(0.0, 2.2, 0.0);
        Affine3A::from_scale_rotation_translation(stretch, turn, place)
    }
}

pub fn scene(seed: u64, gpu: &Gpu) -> Stage {
    let random = &mut Random(seed);
    let bodies: Vec<Body> = (0..1 + random.below(4))
        .map(|_| Body::caster(random.shape(), random.transform()))
        .collect();
    // Far, near, inside a caster's box, or infinitely far.
    let light = match random.below(6) {
        0 | 1 => HomogeneousLight::point(random.point(6.0) + Vec3::new(0.0, 7.0, 0.0)),
        2 => HomogeneousLight::point(random.point(2.0) + Vec3::new(0.0, 2.5, 0.0)),
        3 => {
            let middle = Vec3::from(bodies[0].transform.translation);
            HomogeneousLight::point(middle + random.point(0.2))
        }
        _ => {
            let side = random.point(1.0);
            HomogeneousLight::directional(Vec3::new(side.x, 0.3 + side.y.abs(), side.z))
        }
    };
    let mut stage = Stage::new(light, bodies);
    place_camera(&mut stage, random);
    let depths = depths(gpu);
    stage.depth = depths[random.below(depths.len())];
    let float = wgpu::TextureFormat::Depth32FloatStencil8;
    let has_float = gpu.device.features().contains(float.required_features());
    stage.format = match has_float && random.below(2) == 0 {
        true => float,
        false => wgpu::TextureFormat::Depth24PlusStencil8,
    };
    // Four samples cost five reference pictures.
    stage.samples = if random.below(8) == 0 { 4 } else { 1 };
    stage.side = SIDE;
    if !light.is_directional() && random.below(3) == 0 {
        stage.range = Some(random.within(5.0, 12.0));
    }
    if (seed / 4).is_multiple_of(2) {
        stage.receivers = Some(Stage::bounds(&stage.bodies));
    }
    stage
}

/// Somewhere around, or in the shadow behind a caster.
fn place_camera(stage: &mut Stage, random: &mut Random) {
    let away = random.within(0.0, std::f32::consts::TAU);
    let outside = Vec3::new(8.0 * away.sin(), random.within(1.0, 7.0), 8.0 * away.cos());
    let body = Vec3::from(stage.bodies[1].transform.translation);
    let from_light = match stage.light.is_directional() {
        true => -stage.light.xyzw().truncate(),
        false => body - stage.light.xyzw().truncate(),
    };
    let behind = body + from_light.normalize_or(Vec3::NEG_Y) * random.within(0.2, 1.5);
    stage.eye = if random.below(3) == 0 {
        behind
    } else {
        outside
    };
    stage.eye.y = stage.eye.y.max(0.2);
    stage.target = random.point(1.5) + Vec3::new(0.0, 0.8, 0.0);
    if stage.target.distance(stage.eye) < 0.5 {
        stage.target.x += 3.0;
    }
    stage.field_of_view = random.within(20.0, 150.0).to_radians();
    stage.near = [0.02, 0.1, 0.5][random.below(3)];
}

/// The three ways in which a scene is drawn.
fn choices(seed: u64) -> [Savings; 3] {
    let z_fail = Savings {
        method: Method::ZFail,
        ..Default::default()
    };
    let infinite = Savings {
        extrusion: Extrusion::Infinite,
        ..Default::default()
    };
    let third = if seed.is_multiple_of(2) {
        TEXTBOOK
    } else {
        infinite
    };
    let mut turn = 0;
    [Savings::default(), z_fail, third].map(|savings| {
        turn += 1;
        Savings {
            silhouettes: WAYS[(seed / 4 + turn) as usize % 3],
            start_from: match (seed / 3 + turn) % 2 {
                0 => StartFrom::AwayFacing,
                _ => StartFrom::LightFacing,
            },
            ..savings
        }
    })
}

fn assert_exact(gpu: &Gpu, seed: u64, total: &mut Errors) {
    let stage = scene(seed, gpu);
    let truth = stage.truth();
    for savings in choices(seed) {
        let picture = Stage {
            savings,
            ..stage.clone()
        }
        .draw(gpu);
        let found = truth.errors(&picture);
        assert_eq!(
            found.wrong, 0,
            "seed {seed}, {savings:?}: {found:?}; {:?}, {:?}, {}x, range {:?}, receivers {:?}",
            stage.depth, stage.format, stage.samples, stage.range, stage.receivers
        );
        total.interior += found.interior;
        total.lit += found.lit;
        total.shadowed += found.shadowed;
    }
}

fn assert_all_exact(part: u64) {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut total = Errors {
        interior: 0,
        lit: 0,
        shadowed: 0,
        wrong: 0,
    };
    for seed in (0..SCENES).filter(|seed| seed % 4 == part) {
        assert_exact(&gpu, seed, &mut total);
    }
    assert!(total.interior > 300_000, "{total:?}");
    assert!(total.lit > 100_000 && total.shadowed > 50_000, "{total:?}");
}

#[test]
fn random_scenes_are_exact_1() {
    assert_all_exact(0);
}

#[test]
fn random_scenes_are_exact_2() {
    assert_all_exact(1);
}

#[test]
fn random_scenes_are_exact_3() {
    assert_all_exact(2);
}

#[test]
fn random_scenes_are_exact_4() {
    assert_all_exact(3);
}

#[test]
fn a_forced_z_pass_is_wrong_in_some_of_them() {
    let Some(gpu) = Gpu::for_test() else { return };
    let wrong = (0..40).filter(|seed| {
        let mut stage = scene(*seed, &gpu);
        stage.savings.method = Method::ZPass;
        stage.truth().errors(&stage.draw(&gpu)).wrong > 100
    });
    assert!(wrong.count() >= 3);
}

#[test]
fn every_way_method_convention_format_and_sample_count_is_among_them() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut drawn: HashMap<_, u32> = HashMap::new();
    for seed in 0..SCENES {
        let stage = scene(seed, &gpu);
        for Savings {
            silhouettes,
            method,
            ..
        } in choices(seed)
        {
            let made = (stage.depth, stage.format, stage.samples);
            *drawn.entry((silhouettes, method, made)).or_default() += 1;
        }
    }
    let float = wgpu::TextureFormat::Depth32FloatStencil8;
    let has_float = gpu.device.features().contains(float.required_features());
    let formats = if has_float { 2 } else { 1 };
    // Two methods, one sample or four.
    assert_eq!(
        drawn.len(),
        WAYS.len() * 2 * depths(&gpu).len() * formats * 2
    );
    // Not the same few times over.
    assert!(drawn.values().all(|times| *times < 100), "{drawn:?}");
}
