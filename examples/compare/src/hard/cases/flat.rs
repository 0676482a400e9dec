//! Cases of casters that are flat, or made so.

use shadows::glam::{Affine3A, Quat, Vec3, Vec4};

use super::camera::name;
use super::{Case, Expect};
use crate::hard::situation::{Situation, at, either, with_spots};
use host::random::Random;
use host::shapes;

pub const CASES: [Case; 2] = [
    Case {
        name: "Singular caster",
        build: "a box of scale 0 on one axis, on all, and 1e-38, beside a sphere",
        answer: "its flat shadow, or none; the sphere's as without it",
        situations: singular,
        ..Case::EXACT
    },
    Case {
        name: "Flat caster in the receivers' side",
        build: "a sun over a square at y = 0 that casts and bounds the receivers, half size 300 to 1e4",
        answer: "volumes: equals the reference",
        situations: bounding,
        // Texels as large as the scene.
        maps: Expect::Nothing,
        ..Case::EXACT
    },
];

fn singular(random: &mut Random) -> Vec<Situation> {
    let scales = [
        Vec3::new(1.0, 0.0, 1.0),
        Vec3::new(1.0, 1e-38, 1.0),
        Vec3::ZERO,
        Vec3::splat(1e-38),
    ];
    let turn = Affine3A::from_quat(Quat::from_rotation_z(0.3));
    let situations = scales
        .into_iter()
        .zip(0..)
        .map(|(scale, number)| {
            let light = either(random, number);
            let what = format!("scale {scale}, {}", name(light));
            Situation::new(what, light, random)
                .caster(
                    &shapes::cube(),
                    at(-1.2, 1.8, 0.0) * turn * Affine3A::from_scale(scale),
                )
                .caster(&shapes::sphere(12), at(2.0, 1.3, 0.5))
        })
        .collect();
    with_spots(situations, Vec3::ZERO, 40.0)
}

fn bounding(random: &mut Random) -> Vec<Situation> {
    [300.0_f32, 1e3, 3e3, 1e4]
        .into_iter()
        .map(|half| {
            let toward = Vec3::new(-0.4, 1.0, 0.3) + random.point(0.3);
            let light: Vec4 = toward.normalize().extend(0.0);
            Situation::new(format!("half size {half}"), light, random)
                .bare()
                .caster(&shapes::square(half), Affine3A::IDENTITY)
                .caster(&shapes::sphere(12), at(0.5, 1.6, 0.3))
        })
        .collect()
}
