//! Cases of what a depth buffer can tell apart.

use shadows::glam::{Affine3A, Vec3, Vec4};
use shadows::{DepthConvention, wgpu};

use super::camera::name;
use super::{Case, Expect};
use crate::hard::situation::{Situation, at, either};
use host::random::Random;
use host::renderer::Look;
use host::shapes::{self, Shape};

const TWENTY_FOUR_BITS: wgpu::TextureFormat = wgpu::TextureFormat::Depth24PlusStencil8;

pub const CASES: [Case; 3] = [
    Case {
        name: "Near plane through a caster",
        build: "near 9 of scene depth 10, in every depth convention",
        answer: "volumes: equals the reference",
        situations: near_plane,
        maps: Expect::Nothing,
        ..Case::EXACT
    },
    Case {
        name: "Landscape",
        build: "a kilometre of hills under a sun, camera near 10, 0.1, 0.02",
        answer: "volumes: equals the reference",
        situations: |random| landscape(random, None),
        maps: Expect::Nothing,
        ..Case::EXACT
    },
    Case {
        name: "24-bit depth-stencil",
        build: "the landscape in `Depth24PlusStencil8`",
        answer: "volumes: wrong pixels stated; floats are the default",
        situations: |random| landscape(random, Some(TWENTY_FOUR_BITS)),
        maps: Expect::Nothing,
        ..Case::EXACT
    },
];

fn near_plane(random: &mut Random) -> Vec<Situation> {
    let depths = [
        DepthConvention::Standard,
        DepthConvention::Standard,
        DepthConvention::FiniteReverse,
        DepthConvention::InfiniteReverse,
    ];
    depths
        .into_iter()
        .zip(0..)
        .map(|(depth, turn)| {
            let light = either(random, turn);
            let mut situation =
                Situation::new(format!("{depth:?}, {}", name(light)), light, random)
                    .caster(&shapes::cube().tilted(), at(-1.5, 1.9, 0.0))
                    .caster(&shapes::sphere(20), at(-0.5, 1.5, 1.5))
                    .caster(&shapes::cube(), at(1.8, 1.0, 0.5));
            situation.look = Look {
                depth,
                ..Look::default()
            };
            let camera = &mut situation.scene.camera;
            camera.near = 0.9 * camera.eye.distance(camera.target);
            situation
        })
        .collect()
}

fn landscape(random: &mut Random, format: Option<wgpu::TextureFormat>) -> Vec<Situation> {
    [10.0_f32, 0.1, 0.02]
        .into_iter()
        .map(|near| {
            let light: Vec4 = (Vec3::new(-1.0, 0.4, 0.2) + random.point(0.1))
                .normalize()
                .extend(0.0);
            let mut situation = Situation::new(format!("near {near}"), light, random)
                .bare()
                .caster(&hills(random), Affine3A::IDENTITY)
                .camera(
                    Vec3::new(20.0, 90.0, 480.0) + random.point(10.0),
                    Vec3::new(0.0, 10.0, -100.0),
                );
            situation.scene.camera.near = near;
            situation.look.depth_stencil = format;
            situation
        })
        .collect()
}

/// A square kilometre of smooth hills, 60 m high.
fn hills(random: &mut Random) -> Shape {
    const SIDE: u32 = 96;
    let phase = random.point(3.0);
    let place = |i: u32| (i as f32 / SIDE as f32 - 0.5) * 1000.0;
    let height = |x: f32, z: f32| {
        30.0 * (x / 60.0 + phase.x).sin() * (z / 75.0 + phase.y).cos()
            + 8.0 * ((x + z) / 23.0 + phase.z).sin()
    };
    let corners = (0..=SIDE).flat_map(|z| (0..=SIDE).map(move |x| (place(x), place(z))));
    let squares = (0..SIDE).flat_map(|z| (0..SIDE).map(move |x| z * (SIDE + 1) + x));
    Shape {
        positions: corners.map(|(x, z)| [x, height(x, z), z]).collect(),
        indices: squares
            .flat_map(|a| {
                let (b, c, d) = (a + SIDE + 1, a + SIDE + 2, a + 1);
                [a, b, c, a, c, d]
            })
            .collect(),
    }
}
