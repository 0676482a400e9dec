//! Cases of the camera and of the host's buffers.

use shadows::DepthConvention;
use shadows::glam::{Vec3, Vec4};

use super::Case;
use crate::hard::situation::{Situation, at, either, lamp, sun, with_spots};
use host::random::Random;
use host::renderer::{Look, Orthographic};
use host::shapes;

pub const CASES: [Case; 9] = [
    Case {
        name: "Camera inside a shadow volume",
        build: "eye behind a box from the light",
        answer: "equals the reference",
        situations: inside_a_volume,
        cheap: &["planar", "projected", "baked"],
        ..Case::EXACT
    },
    Case {
        name: "Near plane cuts a volume's side",
        build: "a silhouette quad slides through the near rectangle, field of view 30, 90, 150 degrees",
        answer: "no inverted half screen",
        situations: near_plane_cuts,
        ..Case::EXACT
    },
    Case {
        name: "Receiver far away",
        build: "receivers from 1e6 to 1e7 x near",
        answer: "equals the reference",
        situations: receiver_far_away,
        cheap: &["planar", "planar-soft", "projected"],
        ..Case::EXACT
    },
    Case {
        name: "Nothing drawn at a pixel",
        build: "casters and light over no ground",
        answer: "background not shaded, not shadowed",
        situations: no_ground,
        ..Case::EXACT
    },
    Case {
        name: "Grazing light",
        build: "N.L of the ground 1e-2, 1e-3, 1e-4, 1e-5 in the middle of the picture",
        answer: "maps: acne and leak reported; volumes: exact",
        situations: grazing,
        cheap: &["planar", "projected"],
        ..Case::EXACT
    },
    Case {
        name: "Equal-depth light pass",
        build: "a host that multiplies its matrices before its positions",
        answer: "no z-fighting",
        situations: other_arithmetic,
        ..Case::EXACT
    },
    Case {
        name: "Depth clamp against infinite projection",
        build: "finite reversed and standard depth, far = 1e3 x near",
        answer: "same picture",
        situations: conventions,
        ..Case::EXACT
    },
    Case {
        name: "Orthographic camera, near < 0",
        build: "near planes 20, 50 and 1000 behind the camera, off centre, finite reversed and standard depth",
        answer: "equals the reference",
        situations: orthographic,
        cheap: &["planar", "projected", "blob"],
        ..Case::EXACT
    },
    Case {
        name: "MSAA 4x",
        build: "sloped edges, four samples a pixel",
        answer: "per-sample stencil",
        situations: four_samples,
        cheap: &["planar", "planar-soft", "projected", "blob"],
        ..Case::EXACT
    },
];

fn inside_a_volume(random: &mut Random) -> Vec<Situation> {
    let situations = (0..2)
        .map(|turn| {
            let light = either(random, turn);
            let middle = Vec3::new(0.0, 2.2, 0.0) + random.point(0.3);
            let away = (middle - light.truncate()) * light.w - light.truncate() * (1.0 - light.w);
            let eye = middle + away.normalize() * random.within(1.9, 2.2);
            Situation::new(name(light), light, random)
                .caster(&shapes::cube().tilted(), at(middle.x, middle.y, middle.z))
                .caster(&shapes::sphere(10), at(3.5, 1.2, -1.5))
                .camera(eye, Vec3::new(4.0, 0.5, -3.0) + random.point(0.5))
        })
        .collect();
    with_spots(situations, Vec3::new(3.0, 0.0, -2.0), 35.0)
}

fn near_plane_cuts(random: &mut Random) -> Vec<Situation> {
    let mut situations = Vec::new();
    for degrees in [30.0f32, 90.0, 150.0] {
        for light in [Vec4::Y, Vec4::new(0.0, 8.0, 0.0, 1.0)] {
            // The light is overhead: the edge of the square's shadow runs down near z = 1.2.
            let eye = Vec3::new(0.0, 1.2, random.within(1.3, 1.6));
            let mut situation =
                Situation::new(format!("{}, {degrees} degrees", name(light)), light, random)
                    .caster(&shapes::square(1.2), at(0.0, 2.0, 0.0))
                    .camera(eye, eye + Vec3::new(0.1, -0.6, -1.0));
            situation.scene.camera.fovy = degrees.to_radians();
            situation.scene.camera.near = 0.2;
            situations.push(situation);
        }
    }
    situations
}

fn receiver_far_away(random: &mut Random) -> Vec<Situation> {
    let situations = (0..2)
        .map(|turn| {
            let light = either(random, turn);
            let mut situation = Situation::new(name(light), light, random)
                .caster(&shapes::cube().tilted(), at(-1.5, 1.8, 0.0))
                .caster(&shapes::sphere(12), at(1.5, 1.4, 0.5));
            situation.scene.camera.near = 1e-6; // the ground begins some 7 away
            situation
        })
        .collect();
    with_spots(situations, Vec3::ZERO, 40.0)
}

fn no_ground(random: &mut Random) -> Vec<Situation> {
    (0..2)
        .map(|turn| {
            let light = either(random, turn);
            Situation::new(name(light), light, random)
                .bare()
                .caster(&shapes::sphere(16), at(-0.8, 2.6, 0.8))
                .caster(&shapes::cube().tilted(), at(0.8, 0.6, -0.4))
        })
        .collect()
}

fn grazing(random: &mut Random) -> Vec<Situation> {
    let situations = [1e-2f32, 1e-3, 1e-4, 1e-5]
        .into_iter()
        .flat_map(|slope| {
            let lamp = Vec4::new(-8.0, 8.0 * slope, 1.0, 1.0);
            let sun = Vec4::new(-1.0, slope, 0.1, 0.0);
            [lamp, sun].map(|light| (light, slope))
        })
        .map(|(light, slope)| {
            Situation::new(format!("{}, N.L {slope:e}", name(light)), light, random)
                .caster(&shapes::cube(), at(-2.0, 1.0, 0.5))
                .caster(&shapes::sphere(12), at(1.5, 1.0, -0.5))
        })
        .collect();
    with_spots(situations, Vec3::ZERO, 45.0)
}

fn other_arithmetic(random: &mut Random) -> Vec<Situation> {
    looks(
        random,
        &[Look {
            premultiplied: true,
            ..Look::default()
        }],
    )
}

fn conventions(random: &mut Random) -> Vec<Situation> {
    let depths = [DepthConvention::FiniteReverse, DepthConvention::Standard];
    let looks_of = depths.map(|depth| Look {
        depth,
        ..Look::default()
    });
    looks(random, &looks_of)
}

fn four_samples(random: &mut Random) -> Vec<Situation> {
    looks(
        random,
        &[Look {
            samples: 4,
            ..Look::default()
        }],
    )
}

fn orthographic(random: &mut Random) -> Vec<Situation> {
    let depths = [DepthConvention::FiniteReverse, DepthConvention::Standard];
    let views = [(-20.0, 25.0), (-50.0, 60.0), (-1000.0, 20.0)];
    let looks_of: Vec<Look> = views
        .into_iter()
        .zip(depths.into_iter().cycle())
        .map(|((near, far), depth)| Look {
            depth,
            orthographic: Some(Orthographic {
                left: -4.0,
                right: 6.0,
                bottom: -4.5,
                top: 3.0,
                near,
                far,
            }),
            ..Look::default()
        })
        .collect();
    let mut situations = looks(random, &looks_of);
    // What is behind the camera is seen, too: it stands in the middle of things.
    for situation in &mut situations {
        let camera = &mut situation.scene.camera;
        let forward = (camera.target - camera.eye).normalize();
        let middle = camera.eye.dot(forward) - camera.target.dot(forward);
        camera.eye -= forward * (middle + random.within(-1.0, 1.0));
        camera.target = camera.eye + forward;
    }
    with_spots(situations, Vec3::new(0.5, 0.5, 0.0), 40.0)
}

/// Slopes, a contact and a smooth form, under both lights, as each of these hosts draws them.
fn looks(random: &mut Random, looks: &[Look]) -> Vec<Situation> {
    let mut situations = Vec::new();
    for &look in looks {
        for light in [lamp(random), sun(random)] {
            let what = format!("{}, {look:?}", name(light));
            let mut situation = Situation::new(what, light, random)
                .caster(&shapes::cube().tilted(), at(-1.5, 1.9, 0.0))
                .caster(&shapes::cube(), at(0.8, 1.0, -2.5))
                .caster(&shapes::sphere(16), at(2.0, 1.4, 0.5));
            situation.look = look;
            situations.push(situation);
        }
    }
    situations
}

/// What kind of light it is.
pub fn name(light: Vec4) -> &'static str {
    if light.w == 0.0 { "sun" } else { "lamp" }
}
