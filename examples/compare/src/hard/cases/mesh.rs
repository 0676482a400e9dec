//! Cases of the casters' meshes.

use shadows::glam::{Affine3A, Quat, Vec3};

use super::camera::name;
use super::{Case, Expect};
use crate::hard::situation::{Situation, at, either, with_spots};
use host::random::Random;
use host::shapes::{self, Shape};

pub const CASES: [Case; 9] = [
    Case {
        name: "Slivers, zero area, repeated index",
        build: "a sliver of aspect 1e6, collinear corners, a repeated corner",
        answer: "same picture as without the face",
        situations: slivers,
        ..Case::EXACT
    },
    Case {
        name: "Duplicated vertices",
        build: "a box of 24 vertices, -0 against +0",
        answer: "same as the box of 8",
        situations: duplicated,
        ..Case::EXACT
    },
    Case {
        name: "T-junction",
        build: "one side of an edge split where f32 has no exact midpoint",
        answer: "at most one-pixel streaks; reported by the topology report",
        situations: t_junction,
        volumes: Expect::Streaks("the two sides of the split edge are not the same line"),
        ..Case::EXACT
    },
    Case {
        name: "Open mesh",
        build: "a square and a hemisphere, both windings",
        answer: "casts from both sides",
        situations: open,
        cheap: &["planar", "baked"],
        ..Case::EXACT
    },
    Case {
        name: "Non-manifold edge",
        build: "3 and 4 fins on one edge",
        answer: "equals the reference",
        situations: fins,
        ..Case::EXACT
    },
    Case {
        name: "Mixed winding",
        build: "half of a sphere's faces flipped, and every other one",
        answer: "equals the reference",
        situations: mixed,
        ..Case::EXACT
    },
    Case {
        name: "Mirrored and sheared transforms",
        build: "scale (-1, 1, 1) and (1, 0.01, 100)",
        answer: "equals the reference",
        situations: transforms,
        cheap: &["planar", "projected", "baked"],
        ..Case::EXACT
    },
    Case {
        name: "Instances",
        build: "one mesh nine times, one mirrored",
        answer: "independent shadows",
        situations: instances,
        cheap: &["planar", "planar-soft", "projected", "blob", "baked"],
        ..Case::EXACT
    },
    Case {
        name: "Thin caster",
        build: "a wire of a tenth of a texel",
        answer: "volumes exact; maps: loss reported",
        situations: wire,
        cheap: &["planar", "projected"],
        ..Case::EXACT
    },
];

/// One caster with another beside it, under a lamp and a sun.
fn under_both(
    random: &mut Random,
    what: &str,
    shape: &Shape,
    transform: Affine3A,
) -> Vec<Situation> {
    (0..2)
        .map(|turn| {
            let light = either(random, turn);
            Situation::new(format!("{what}, {}", name(light)), light, random)
                .caster(shape, transform)
                .caster(&shapes::sphere(10), at(-2.8, 0.9, -1.5))
        })
        .collect()
}

fn slivers(random: &mut Random) -> Vec<Situation> {
    let mut shape = shapes::square(1.2);
    let first = shape.positions.len() as u32;
    shape.positions.extend([
        [-1.1, 0.6, -0.4],
        [1.1, 0.7, 0.5],
        [1.1, 0.7, 0.500_002_2],
        [0.0, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.25, 0.25, 0.0],
        [0.2, 0.9, 0.1],
        [0.2, 0.9, 0.1],
    ]);
    shape
        .indices
        .extend([0, 1, 2, 3, 4, 5, 3, 3, 4, 5, 6, 7].map(|i| first + i));
    under_both(random, "square", &shape, at(0.0, 1.0, 0.0))
}

fn duplicated(random: &mut Random) -> Vec<Situation> {
    let mut shape = shapes::cube();
    // A middle plane at 0, whose two halves write that number with either sign.
    for (number, position) in shape.positions.iter_mut().enumerate() {
        let zero = if number % 2 == 0 { 0.0 } else { -0.0 };
        position[1] = if position[1] < 0.0 { zero } else { position[1] };
    }
    under_both(random, "24 vertices", &shape, at(0.0, 1.0, 0.0))
}

fn t_junction(random: &mut Random) -> Vec<Situation> {
    under_both(random, "split square", &split_square(), at(0.0, 1.5, 0.0))
}

/// A square whose diagonal is split on one side, a little beside itself.
pub fn split_square() -> Shape {
    Shape {
        indices: vec![0, 1, 2, 0, 4, 3, 4, 2, 3],
        ..whole_square()
    }
}

/// The same square with one diagonal for both its triangles.
pub fn whole_square() -> Shape {
    Shape {
        positions: vec![
            [-1.0, 0.0, -1.0],
            [-1.0, 0.1, 1.0],
            [1.0, 0.3, 1.0],
            [1.0, -0.2, -1.0],
            [0.1, 0.165, 0.1],
        ],
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

fn open(random: &mut Random) -> Vec<Situation> {
    let half = shapes::sphere(16).cut(|corners| corners.iter().all(|c| c.y > -1e-3));
    let tilted = Affine3A::from_rotation_translation(
        Quat::from_rotation_z(0.5) * Quat::from_rotation_x(0.3),
        Vec3::new(0.2, 1.6, 0.1),
    );
    [
        ("square", shapes::square(1.2)),
        ("square, reversed", shapes::square(1.2).reversed()),
        ("hemisphere", half.clone()),
        ("hemisphere, reversed", half.reversed()),
    ]
    .into_iter()
    .flat_map(|(what, shape)| under_both(random, what, &shape, tilted))
    .collect()
}

fn fins(random: &mut Random) -> Vec<Situation> {
    [3, 4]
        .into_iter()
        .flat_map(|count| {
            let shape = shapes::fins(count);
            under_both(random, &format!("{count} fins"), &shape, at(0.0, 0.5, 0.0))
        })
        .collect()
}

fn mixed(random: &mut Random) -> Vec<Situation> {
    let half = shapes::sphere(16).turned(|triangle| triangle < 512);
    let every_other = shapes::sphere(16).turned(|triangle| triangle % 2 == 0);
    [("half", half), ("every other", every_other)]
        .into_iter()
        .flat_map(|(what, shape)| under_both(random, what, &shape, at(0.0, 1.5, 0.0)))
        .collect()
}

fn transforms(random: &mut Random) -> Vec<Situation> {
    let turn = Quat::from_rotation_z(0.4) * Quat::from_rotation_x(-0.3);
    [
        ("mirrored", Vec3::new(-1.0, 1.0, 1.0), turn),
        // 200 long and a fiftieth thick; it leaves the picture on both sides.
        (
            "sheared",
            Vec3::new(1.0, 0.01, 100.0),
            Quat::from_rotation_y(1.5),
        ),
    ]
    .into_iter()
    .flat_map(|(what, scale, turn)| {
        let place =
            Affine3A::from_scale_rotation_translation(scale, turn, Vec3::new(0.3, 1.8, -0.2));
        under_both(random, what, &shapes::cube().tilted(), place)
    })
    .collect()
}

fn instances(random: &mut Random) -> Vec<Situation> {
    let shape = shapes::cube().tilted();
    (0..2)
        .map(|turn| {
            let light = either(random, turn);
            let situation = Situation::new(name(light), light, random);
            (0..9).fold(situation, |situation, i| {
                let mirror = if i == 4 { -1.0 } else { 1.0 };
                let place = Affine3A::from_scale_rotation_translation(
                    Vec3::new(mirror, 1.0, 1.0) * 0.4,
                    Quat::from_rotation_y(0.7 * i as f32),
                    Vec3::new(1.6 * (i % 3) as f32 - 1.6, 0.9, 1.6 * (i / 3) as f32 - 1.6),
                );
                situation.caster(&shape, place)
            })
        })
        .collect()
}

fn wire(random: &mut Random) -> Vec<Situation> {
    // 6 from the light, a texel of a 512 face is 0.023.
    let thin = Affine3A::from_scale(Vec3::new(2.0, 0.0012, 0.0012));
    let turn = Affine3A::from_rotation_y(0.4);
    let situations = (0..2)
        .map(|turn_of| {
            let light = either(random, turn_of);
            Situation::new(name(light), light, random)
                .caster(&shapes::cube(), at(0.0, 1.5, 0.5) * turn * thin)
                .caster(&shapes::sphere(10), at(-2.8, 0.9, -1.5))
        })
        .collect();
    with_spots(situations, Vec3::ZERO, 40.0)
}
