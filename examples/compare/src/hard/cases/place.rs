//! Cases of where the scene is, how large, and how many casters overlap.

use shadows::glam::{Affine3A, DVec3, Quat, Vec3, Vec4};

use super::camera::name;
use super::{Case, Expect};
use crate::hard::situation::{Situation, at, either, lamp, sun, with_spots};
use host::random::Random;
use host::shapes;

pub const CASES: [Case; 7] = [
    Case {
        name: "8-bit stencil wrap",
        build: "255, 256, 257, 512 stacked squares; 128 stacked boxes with both sides",
        answer: "shadow; at multiples of 256 the 8-bit count reads lit and says so, the exact one never",
        situations: stacks,
        volumes: Expect::Wraps,
        cheap: &["planar"],
        ..Case::EXACT
    },
    Case {
        name: "Far from the origin",
        build: "the scene + 1e5, 1e6, 1e7, placed in f64",
        answer: "same picture as at the origin",
        situations: far,
        cheap: &["planar", "projected"],
        ..Case::EXACT
    },
    Case {
        name: "Far from the origin, plain f32",
        build: "the scene + 1e2 .. 1e6 with f32 positions from the origin, maps of 512 and 4096 texels",
        answer: "maps: same picture but for 1e-6 of the distance beside shadow edges; volumes: reported",
        situations: far_plain,
        fine: true,
        ..Case::EXACT
    },
    Case {
        name: "Scale",
        build: "the whole scene x 1e-4, x 1e5",
        answer: "same picture",
        situations: scale,
        cheap: &["planar", "projected"],
        ..Case::EXACT
    },
    Case {
        name: "Touching",
        build: "a box resting on a plane",
        answer: "no light gap beyond the stated leak (2 texels)",
        situations: touching,
        cheap: &["planar", "planar-soft", "projected", "blob", "baked"],
        ..Case::EXACT
    },
    Case {
        name: "Cube seams and corners",
        build: "inside a room, boxes across all 12 edges, 8 corners and 6 face centres, the room turned 0 to 45 degrees",
        answer: "wrong pixels no more than at face centres",
        situations: seams,
        seams: true,
        ..Case::EXACT
    },
    Case {
        name: "16-bit map",
        build: "range 1000, casters within 3",
        answer: "equals the reference; 16 bits are no worse than 32, given the near plane that the map chooses",
        situations: long_range,
        sixteen_bits: true,
        ..Case::EXACT
    },
];

fn stacks(random: &mut Random) -> Vec<Situation> {
    let sheets = [255u32, 256, 257, 512].map(|count| {
        // Straight light, and a stack thinner than a pixel: each point is under all or none.
        let mut situation = Situation::new(format!("{count} squares"), Vec4::Y, random);
        situation.wraps = count % 256 == 0;
        (0..count).fold(situation, |situation, sheet| {
            situation.caster(
                &shapes::square(1.0),
                at(0.0, 1.0 + 2e-5 * sheet as f32, 0.0),
            )
        })
    });
    let both = shapes::cube().with(&shapes::cube().reversed());
    let boxes = (0..128).fold(
        Situation::new("128 two-sided boxes", Vec4::Y, random),
        |situation, number| {
            let flat = Affine3A::from_scale(Vec3::new(1.0, 1e-5, 1.0));
            situation.caster(&both, at(0.0, 1.0 + 4e-5 * number as f32, 0.0) * flat)
        },
    );
    let boxes = Situation {
        wraps: true,
        ..boxes
    };
    sheets.into_iter().chain([boxes]).collect()
}

/// A box in the air, a box on the ground and a smooth form.
fn mixed(what: String, light: Vec4, random: &mut Random) -> Situation {
    Situation::new(what, light, random)
        .caster(&shapes::cube().tilted(), at(-1.5, 1.9, 0.0))
        .caster(&shapes::cube(), at(0.8, 1.0, -2.5))
        .caster(&shapes::sphere(16), at(2.0, 1.4, 0.5))
}

fn far(random: &mut Random) -> Vec<Situation> {
    let mut situations = Vec::new();
    for distance in [1e5, 1e6, 1e7] {
        for turn in 0..2 {
            let light = either(random, turn);
            let what = format!("{distance:e}, {}", name(light));
            let mut situation = mixed(what, light, random);
            // Off the axes, and no round number.
            let offset = DVec3::new(0.61, -0.48, 0.63) * distance;
            situation.offset = offset + random.point(1.0).as_dvec3();
            situations.push(situation);
        }
    }
    with_spots(situations, Vec3::ZERO, 40.0)
}

/// So far from an edge, as a part of the distance from the origin, positions in f32 let a map err:
/// docs/numerics.md.
const LEAK: f32 = 1e-6;

fn far_plain(random: &mut Random) -> Vec<Situation> {
    let mut situations = Vec::new();
    for (turn, distance) in (0..).zip([1e2, 1e3, 1e4, 1e5, 1e6]) {
        for light in [lamp(random), sun(random)] {
            let what = format!("{distance:e}, {}", name(light));
            // All axes far, or one of them, on either side.
            let direction = match turn % 3 {
                0 => DVec3::new(0.61, -0.48, 0.63),
                1 => DVec3::new(-1.0, 2e-3, 1e-3),
                _ => DVec3::new(0.1, 0.02, -0.99),
            };
            let offset = direction * distance + random.point(1.0).as_dvec3();
            let mut situation = mixed(what, light, random);
            situation.leak = LEAK * distance as f32;
            situation.offset = offset;
            situations.push(situation);
        }
    }
    let plain = |mut situation: Situation| {
        let offset = std::mem::take(&mut situation.offset);
        situation.moved(offset)
    };
    let all = with_spots(situations, Vec3::ZERO, 40.0);
    all.into_iter().map(plain).collect()
}

fn scale(random: &mut Random) -> Vec<Situation> {
    let mut situations = Vec::new();
    for factor in [1e-4, 1e5] {
        for turn in 0..2 {
            let light = either(random, turn);
            let what = format!("x {factor:e}, {}", name(light));
            let of_one = vec![mixed(what, light, random)];
            let tried = with_spots(of_one, Vec3::ZERO, 40.0);
            situations.extend(tried.into_iter().map(|situation| situation.scaled(factor)));
        }
    }
    situations
}

fn touching(random: &mut Random) -> Vec<Situation> {
    let situations = (0..2)
        .map(|turn| {
            let light = either(random, turn);
            let turned = Affine3A::from_rotation_y(random.within(0.0, 1.5));
            Situation::new(name(light), light, random)
                .caster(&shapes::cube(), at(0.0, 1.0, 0.0) * turned)
        })
        .collect();
    with_spots(situations, Vec3::ZERO, 40.0)
}

fn seams(random: &mut Random) -> Vec<Situation> {
    [0.0f32, 22.5, 45.0]
        .into_iter()
        .map(|degrees| {
            let turn = Quat::from_rotation_y(degrees.to_radians())
                * Quat::from_rotation_x(0.5 * degrees.to_radians());
            let light = random.point(0.1).extend(1.0);
            let room =
                Affine3A::from_scale_rotation_translation(Vec3::splat(5.0), turn, Vec3::ZERO);
            let situation = Situation::new(format!("{degrees} degrees"), light, random)
                .bare()
                .receiver(&shapes::cube().reversed(), room);
            let mut situation = directions().fold(situation, |situation, direction| {
                let place = Affine3A::from_translation(direction * 1.5 + random.point(0.1));
                let small = Affine3A::from_scale(Vec3::splat(0.2));
                situation.caster(&shapes::cube().tilted(), place * small)
            });
            let eye = turn * Vec3::new(-4.2, 3.1, 4.4);
            situation.scene.camera.fovy = 1.9;
            situation.camera(eye, turn * Vec3::new(1.0, -1.5, -1.0))
        })
        .collect()
}

/// The middles of a cube's faces, where two of them meet, and where three do.
fn directions() -> impl Iterator<Item = Vec3> {
    (0..27)
        .map(|i| {
            Vec3::new(
                (i % 3 - 1) as f32,
                (i / 3 % 3 - 1) as f32,
                (i / 9 - 1) as f32,
            )
        })
        .filter(|direction| direction.length_squared() > 0.5)
}

fn long_range(random: &mut Random) -> Vec<Situation> {
    let light = crate::hard::situation::lamp(random);
    let mut situation = mixed("range 1000".into(), light, random);
    situation.scene.light_mut().range = 1000.0;
    vec![situation]
}
