//! Cases of the light.

use shadows::glam::{Affine3A, Vec3, Vec4};

use super::Case;
use super::camera::name;
use crate::hard::situation::{Situation, at, lamp, with_spots};
use host::random::Random;
use host::shapes;

pub const CASES: [Case; 10] = [
    Case {
        name: "Light very near a caster",
        build: "light in view, 1e-2, 1e-4 and 1e-6 above a square",
        answer: "finite, equals the reference",
        situations: near_a_caster,
        ..Case::EXACT
    },
    Case {
        name: "Light close to geometry",
        build: "a lamp in a slit shade; 1 km of hills under a lamp 1.2 m and 1 cm above the ground",
        answer: "equals the reference; the near plane is not the host's care",
        situations: close_to_geometry,
        ..Case::EXACT
    },
    Case {
        name: "Light 1e-6 from a tilted caster",
        build: "1e-6 of a triangle's size off a tilted square and off a tilted box's edge",
        answer: "finite, equals the reference; facing in f32: reported",
        situations: near_a_tilted_caster,
        ..Case::EXACT
    },
    Case {
        name: "Light inside a closed caster",
        build: "a box around the light, whole and without its floor",
        answer: "finite, equals the reference",
        situations: inside_a_caster,
        cheap: &["planar", "projected"],
        ..Case::EXACT
    },
    Case {
        name: "Light in a triangle's plane",
        build: "a sheet in the plane z = 0, the light on z = 0",
        answer: "facing 0; the volume stays closed",
        situations: in_a_plane,
        ..Case::EXACT
    },
    Case {
        name: "Light on a vertex, on an edge's midpoint",
        build: "light = v, light = (a + b) / 2, of a box and of a square",
        answer: "no NaN, equals the reference elsewhere",
        situations: on_a_vertex,
        ..Case::EXACT
    },
    Case {
        name: "Beyond the light's range",
        build: "a range that ends on the ground in view; receivers at the range and 1 ulp to either side",
        answer: "outside is not lit by this light; no wrap",
        situations: range,
        ..Case::EXACT
    },
    Case {
        name: "Cone's edge",
        build: "casters across the edge of a spot of 10, 30 and 60 degrees to each side",
        answer: "equals the reference in the cone",
        situations: cone_edge,
        ..Case::EXACT
    },
    Case {
        name: "Caster inside the near sphere",
        build: "a box at half the map's near distance",
        answer: "equals the reference: maps pull it onto their near plane",
        situations: inside_near,
        ..Case::EXACT
    },
    Case {
        name: "Light inside the view",
        build: "the lamp among the casters, in the middle of the picture",
        answer: "equals the reference",
        situations: in_view,
        ..Case::EXACT
    },
];

fn near_a_caster(random: &mut Random) -> Vec<Situation> {
    let situations: Vec<Situation> = [1e-2f32, 1e-4, 1e-6]
        .into_iter()
        .map(|height| {
            // Just above 1, where f32 still tells 1e-6 apart.
            let spot = random.point(0.3);
            let light = Vec4::new(0.1 + spot.x, 1.0 + height, 0.2 + spot.z, 1.0);
            Situation::new(format!("{height:e} above"), light, random)
                .caster(&shapes::square(1.0), at(0.0, 1.0, 0.0))
                .caster(
                    &shapes::sphere(10),
                    at(-1.5, 2.5, -1.0) * Affine3A::from_scale(Vec3::splat(0.7)),
                )
        })
        .collect();
    // At the sphere, which is lit; the lower side of the cone is all in the square's shadow.
    with_spots(situations, Vec3::new(-1.5, 2.2, -1.0), 60.0)
}

fn close_to_geometry(random: &mut Random) -> Vec<Situation> {
    let lamp = Vec3::new(0.0, 1.5, 0.0) + random.point(0.05);
    let shade = Situation::new("slit shade", lamp.extend(1.0), random)
        .caster(&shapes::slit_tube(0.2, 0.3, 12), at(0.0, 1.5, 0.0))
        .caster(&shapes::sphere(10), at(-2.5, 1.0, -1.0));
    let spot = shade.clone().spot(Vec3::new(3.0, 0.0, 0.0), 60.0);
    let mut situations = vec![shade, spot];
    situations.extend([1.2f32, 0.01].map(|height| above_hills(height, random)));
    situations
}

/// A kilometre of hills, seen from some 100 m above, under a lamp at so many metres above a vertex.
fn above_hills(height: f32, random: &mut Random) -> Situation {
    let hills = shapes::hills(500.0, 128);
    let near_by = |p: &&[f32; 3]| p[0].abs().max(p[2].abs()) < 60.0;
    let around: Vec<_> = hills.positions.iter().filter(near_by).collect();
    let ground = *around[random.below(around.len())];
    let light = Vec3::from(ground) + Vec3::Y * height;
    let eye = Vec3::new(20.0, 90.0, 130.0) + random.point(10.0);
    let mut situation =
        Situation::new(format!("{height} m above hills"), light.extend(1.0), random)
            .bare()
            .caster(&hills, Affine3A::IDENTITY)
            .camera(eye, Vec3::new(0.0, 0.0, -20.0));
    situation.scene.light_mut().range = 1000.0;
    situation
}

fn near_a_tilted_caster(random: &mut Random) -> Vec<Situation> {
    [
        (
            "square",
            shapes::square(1.0).tilted(),
            Vec3::new(0.31, 0.0, 0.17),
            Vec3::Y,
        ),
        (
            "box, its edge",
            shapes::cube().tilted(),
            Vec3::new(1.0, 1.0, 0.23),
            Vec3::new(1.0, 1.0, 0.0).normalize(),
        ),
    ]
    .into_iter()
    .map(|(what, shape, spot, away)| {
        let turn = shapes::tilt();
        let middle = Vec3::new(0.0, 1.5, 0.0);
        let light = middle + turn * (spot + away * 1e-6);
        Situation::new(what, light.extend(1.0), random)
            .caster(&shape, Affine3A::from_translation(middle))
            .caster(
                &shapes::sphere(10),
                at(-1.5, 2.5, -1.0) * Affine3A::from_scale(Vec3::splat(0.7)),
            )
    })
    .collect()
}

fn inside_a_caster(random: &mut Random) -> Vec<Situation> {
    let light = (Vec3::new(0.1, 2.0, 0.2) + random.point(0.2)).extend(1.0);
    let whole = shapes::cube();
    let floorless = shapes::cube().cut(|corners| corners.iter().any(|c| c.y > -0.5));
    [("whole", whole), ("no floor", floorless)]
        .into_iter()
        .map(|(what, shape)| Situation::new(what, light, random).caster(&shape, at(0.0, 2.0, 0.0)))
        .collect()
}

fn in_a_plane(random: &mut Random) -> Vec<Situation> {
    let upright = Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
    let height = random.within(5.0, 7.0);
    [
        Vec4::new(-2.0, height, 0.0, 1.0),
        Vec4::new(-0.4, 1.0, 0.0, 0.0),
    ]
    .into_iter()
    .map(|light| {
        Situation::new(name(light), light, random)
            .caster(&shapes::square(1.0), at(0.0, 1.5, 0.0) * upright)
            .caster(&shapes::cube(), at(1.5, 1.5, -1.0))
    })
    .collect()
}

fn on_a_vertex(random: &mut Random) -> Vec<Situation> {
    let mut situations = Vec::new();
    for (what, shape, height) in [
        ("box", shapes::cube(), 2.0),
        ("square", shapes::square(1.0), 3.0),
    ] {
        for (where_to, light) in [
            ("vertex", Vec4::new(-1.0, 3.0, 1.0, 1.0)),
            ("edge", Vec4::new(0.0, 3.0, 1.0, 1.0)),
        ] {
            let situation = Situation::new(format!("{what}, {where_to}"), light, random)
                .caster(&shape, at(0.0, height, 0.0))
                .caster(&shapes::sphere(10), at(-2.5, 0.8, 1.5));
            situations.push(situation);
        }
    }
    situations
}

fn range(random: &mut Random) -> Vec<Situation> {
    let situations = [6.5f32, 8.0]
        .into_iter()
        .map(|range| {
            let light = lamp(random);
            let mut situation = Situation::new(format!("range {range}"), light, random)
                .caster(&shapes::cube().tilted(), at(-1.0, 1.9, 0.5))
                .caster(&shapes::sphere(12), at(1.5, 1.4, 0.5));
            situation.scene.light_mut().range = range;
            situation
        })
        .collect();
    let mut situations = with_spots(situations, Vec3::ZERO, 45.0);
    let ends = [6.0f32.next_down(), 6.0, 6.0f32.next_up()];
    situations.extend(ends.map(|range| at_the_range(range, random)));
    situations
}

/// A receiver 6 from the light, so small that all of it is: to its corners it is a third of an ulp
/// farther. With a caster in range, which does not shadow it.
fn at_the_range(range: f32, random: &mut Random) -> Situation {
    let ulps = (range.to_bits() as i32) - 6.0f32.to_bits() as i32;
    let light = Vec4::new(0.0, 6.0, 0.0, 1.0);
    let mut situation = Situation::new(format!("6 away, range {ulps:+} ulp"), light, random)
        .bare()
        .receiver(&shapes::square(1e-3), Affine3A::IDENTITY)
        .caster(&shapes::sphere(10), at(1.0, 2.0, 1.0))
        .camera(Vec3::new(2e-4, 3e-3, 2e-3), Vec3::ZERO);
    situation.scene.light_mut().range = range;
    situation.scene.camera.near = 1e-4;
    situation.no_shadow_in_view = true;
    situation
}

fn cone_edge(random: &mut Random) -> Vec<Situation> {
    [10.0f32, 30.0, 60.0]
        .into_iter()
        .map(|degrees| {
            let light = lamp(random);
            let from = light.truncate();
            let target = Vec3::new(0.0, 0.5, 0.0) + random.point(0.3);
            let axis = (target - from).normalize();
            let across = axis.cross(Vec3::Z).normalize();
            let situation = Situation::new("lamp", light, random)
                .spot(target, degrees)
                .camera(Vec3::new(1.0, 8.0, 14.0), Vec3::ZERO);
            // A little more than halfway to the ground along the cone's edge, on either side.
            let (sine, cosine) = degrees.to_radians().sin_cos();
            [-sine, sine]
                .into_iter()
                .fold(situation, |situation, side| {
                    let ray = cosine * axis + side * across;
                    let place = Affine3A::from_translation(from - 0.6 * from.y / ray.y * ray);
                    let small = Affine3A::from_scale(Vec3::splat(0.35));
                    situation.caster(&shapes::cube().tilted(), place * small)
                })
        })
        .collect()
}

fn inside_near(random: &mut Random) -> Vec<Situation> {
    let light = lamp(random);
    let below = light.truncate() - Vec3::Y * 0.5;
    let mut situation = Situation::new("near 1, box at 0.5", light, random)
        .caster(
            &shapes::cube().tilted(),
            Affine3A::from_translation(below) * Affine3A::from_scale(Vec3::splat(0.05)),
        )
        .caster(&shapes::sphere(12), at(1.5, 1.4, 0.5));
    situation.scene.light_mut().near = Some(1.0);
    with_spots(vec![situation], Vec3::ZERO, 40.0)
}

fn in_view(random: &mut Random) -> Vec<Situation> {
    let light = (Vec3::new(0.0, 1.2, 0.0) + random.point(0.2)).extend(1.0);
    let small = Affine3A::from_scale(Vec3::splat(0.5));
    let around = (0..6).map(|i| {
        let angle = std::f32::consts::TAU * i as f32 / 6.0 + 0.2;
        at(2.0 * angle.cos(), 0.9, 2.0 * angle.sin()) * small
    });
    let situation = Situation::new("six around", light, random);
    vec![around.fold(situation, |situation, place| {
        situation.caster(&shapes::cube().tilted(), place)
    })]
}
