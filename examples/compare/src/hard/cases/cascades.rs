//! Cases of a sun's cascades.

use shadows::glam::{Affine3A, Vec3, Vec4};
use shadows::{CascadeFit, CascadeSplit, Cascades, DepthConvention, ShadowAtlasDescriptor};

use super::Case;
use super::atlas::{frames, light, yard};
use crate::hard::atlas::{Frame, Frames, Lamp, Seen};
use crate::hard::situation::{Situation, at};
use host::random::Random;
use host::renderer::{Look, Orthographic};
use host::scene::{Camera, Light, LightKind};
use host::shapes;

/// Texels along a tile.
const SIDE: u32 = 512;
const FITS: [(&str, CascadeFit); 2] =
    [("stable", CascadeFit::Stable), ("tight", CascadeFit::Tight)];

pub const CASES: [Case; 6] = [
    Case {
        name: "Cascades end in the picture",
        build: "a row of boxes that runs through the ends of four cascades; fits stable and tight, blend 0, 0.1 and 0.5",
        answer: "equals the reference at each cascade's own texels",
        frames: Some(ends),
        ..Case::EXACT
    },
    Case {
        name: "Long view under a low sun",
        build: "four cascades over 400 m of ground and posts, N.L 0.2, 0.05 and 0.02",
        answer: "equals the reference at each cascade's own texels",
        frames: Some(low_sun),
        ..Case::EXACT
    },
    Case {
        name: "Casters far before a cascade",
        build: "plates 30, 1000 and 30,000 m toward the sun, over four cascades",
        answer: "pulled onto each near plane: equals the reference",
        frames: Some(far_before),
        ..Case::EXACT
    },
    Case {
        name: "Cascades of other cameras",
        build: "orthographic with a near plane behind the camera, off centre, 170 and 0.01 degrees, over a field of 80 casters; a sun, a lamp and a spot",
        answer: "equals the reference",
        frames: Some(cameras),
        ..Case::EXACT
    },
    Case {
        name: "Cascades wait while the camera walks",
        build: "one tile a frame, a camera that walks and turns for twelve frames over a still scene",
        answer: "late cascades lie where they were drawn, and say the truth there",
        frames: Some(walk),
        ..Case::EXACT
    },
    Case {
        name: "Two views of a sun",
        build: "a camera and one 28 m away, in perspective or not, under a sun, a lamp and a spot, in one submission",
        answer: "each as alone: equals the reference",
        frames: Some(two_views),
        ..Case::EXACT
    },
];

fn sun(toward: Vec3, cascades: Cascades) -> Lamp {
    Lamp {
        cascades,
        ..Lamp::fixed(Light::new(toward.extend(0.0), 100.0), SIDE)
    }
}

/// A yard with things all around it, so far that no cascade but a wide one holds them all.
fn field(random: &mut Random) -> Situation {
    let shapes = [shapes::cube().tilted(), shapes::sphere(10)];
    let mut field = yard(random);
    for (x, z) in (-4..=4_i8).flat_map(|x| (-4..=4_i8).map(move |z| (x, z))) {
        if x.abs().max(z.abs()) > 1 {
            let place = at(6.5 * f32::from(x), 1.2, 6.5 * f32::from(z));
            let size = Affine3A::from_scale(Vec3::splat(random.within(0.4, 0.8)));
            field = field.caster(&shapes[random.below(2)], place * size);
        }
    }
    field
}

fn toward_sun(random: &mut Random) -> Vec3 {
    Vec3::new(-0.5, 1.0, 0.4) + random.point(0.2)
}

/// Four, each as many times as far as the one before it, up to a distance from the eye.
fn four(distance: f32) -> Cascades {
    Cascades {
        split: CascadeSplit::Practical { lambda: 1.0 },
        distance,
        ..Default::default()
    }
}

/// Over boxes in a row, so close that every end of a cascade goes through one, and through another's shadow.
fn ends(random: &mut Random) -> Vec<Frames> {
    let mut scene = Situation::new("", Vec4::Y, random).bare();
    scene = scene.receiver(&shapes::square(120.0), Affine3A::IDENTITY);
    for step in 0..40_u16 {
        let ahead = 1.2 * 1.1_f32.powi(step.into());
        let size = Affine3A::from_scale(Vec3::new(0.08, 0.04, 0.045) * ahead);
        for side in [-0.45, -0.15, 0.15, 0.45] {
            let place = at(side * ahead, 0.1 * ahead, -ahead);
            scene = scene.caster(&shapes::cube(), place * size);
        }
    }
    let mut scene = scene.scene;
    scene.camera = Camera {
        eye: Vec3::new(0.1, 1.7, 0.5) + random.point(0.1),
        target: Vec3::new(0.0, 0.6, -3.0),
        near: 0.5,
        fovy: 1.1,
    };
    let toward = toward_sun(random);
    let mut all = Vec::new();
    for (name, fit) in FITS {
        for blend in [0.0, 0.1, 0.5] {
            let cascades = Cascades {
                fit,
                blend,
                // The last box is 50 away.
                ..four(58.0)
            };
            let frame = Frame::new(vec![sun(toward, cascades)], scene.camera);
            all.push(frames(
                format!("{name}, blend {blend}"),
                scene.clone(),
                vec![frame],
            ));
        }
    }
    all
}

fn low_sun(random: &mut Random) -> Vec<Frames> {
    let mut scene = Situation::new("", Vec4::Y, random).bare();
    scene = scene.receiver(&shapes::square(200.0), Affine3A::IDENTITY);
    for step in 0..60_u16 {
        let ahead = 2.0 + 0.05 * f32::from(step).powi(2);
        let across = random.within(-0.7, 0.7) * ahead;
        let post = Affine3A::from_scale(Vec3::new(0.15, 1.0, 0.15) * (1.0 + 0.02 * ahead));
        scene = scene.caster(
            &shapes::cube(),
            at(across, 1.0 + 0.02 * ahead, -ahead) * post,
        );
    }
    let mut scene = scene.scene;
    scene.camera = Camera {
        eye: Vec3::new(0.0, 3.0, 4.0) + random.point(0.3),
        target: Vec3::new(0.0, 1.0, -12.0),
        near: 0.1,
        fovy: 0.9,
    };
    let mut all = Vec::new();
    for (name, fit) in FITS {
        for slope in [0.2, 0.05, 0.02] {
            let toward = Vec3::new(-1.0, slope, random.within(-0.4, 0.4));
            let cascades = Cascades { fit, ..four(400.0) };
            let frame = Frame::new(vec![sun(toward, cascades)], scene.camera);
            all.push(frames(
                format!("{name}, slope {slope}"),
                scene.clone(),
                vec![frame],
            ));
        }
    }
    all
}

fn far_before(random: &mut Random) -> Vec<Frames> {
    [30.0_f32, 1e3, 3e4]
        .into_iter()
        .map(|away| {
            let toward = toward_sun(random).normalize();
            let mut scene = yard(random);
            for (x, z) in [(0.0, 4.5), (-2.5, 1.0), (3.0, -6.0), (-6.0, -14.0)] {
                let place = Vec3::new(x, 0.0, z) + toward * away;
                let turned = at(place.x, place.y, place.z) * Affine3A::from_rotation_x(0.3);
                scene = scene.caster(&shapes::square(0.8), turned);
            }
            let camera = scene.scene.camera;
            let lights = FITS.map(|(_, fit)| sun(toward, Cascades { fit, ..four(60.0) }));
            let frame = Frame::new(lights.to_vec(), camera);
            frames(format!("{away} m"), scene.scene, vec![frame])
        })
        .collect()
}

fn cameras(random: &mut Random) -> Vec<Frames> {
    let field = field(random);
    let usual = field.scene.camera;
    let orthographic = |left: f32, near: f32, depth| Seen {
        look: Look {
            depth,
            orthographic: Some(Orthographic {
                left,
                right: left + 12.0,
                bottom: -4.0,
                top: 5.0,
                near,
                far: 60.0,
            }),
            ..Look::default()
        },
        ..Seen::by(usual)
    };
    let wide = Camera {
        fovy: 170.0_f32.to_radians(),
        ..usual
    };
    // So far away that it sees a metre of the yard.
    let away = (usual.eye - usual.target).normalize() * 6000.0;
    let narrow = Camera {
        eye: usual.target + away,
        target: Vec3::new(0.3, 0.9, 0.2),
        fovy: 0.01_f32.to_radians(),
        near: 1.0,
    };
    let seen = [
        (
            "orthographic",
            orthographic(-6.0, -50.0, DepthConvention::FiniteReverse),
        ),
        (
            "orthographic, off centre",
            orthographic(-2.0, 0.5, DepthConvention::Standard),
        ),
        (
            "off centre",
            Seen {
                shift: [0.7, -0.4],
                ..Seen::by(usual)
            },
        ),
        ("170 degrees", Seen::by(wide)),
        ("0.01 degrees", Seen::by(narrow)),
    ];
    seen.map(|(what, seen)| {
        let toward = toward_sun(random);
        // The farthest things are 40 from the middle.
        let distance = seen.camera.eye.distance(seen.camera.target) + 40.0;
        let suns = FITS.map(|(_, fit)| {
            sun(
                toward,
                Cascades {
                    fit,
                    ..four(distance)
                },
            )
        });
        let others = [LightKind::Point, LightKind::Spot];
        let others = others.map(|kind| Lamp::fixed(light(kind, random), SIDE));
        let frame = Frame {
            views: vec![seen],
            ..Frame::new([suns, others].concat(), usual)
        };
        frames(what, field.scene.clone(), vec![frame])
    })
    .into()
}

fn walk(random: &mut Random) -> Vec<Frames> {
    let field = field(random);
    let toward = toward_sun(random);
    let from = field.scene.camera.eye;
    let all = FITS.map(|(name, fit)| {
        let cascades = Cascades { fit, ..four(60.0) };
        let frame = |step: u16| {
            let along = f32::from(step) / 11.0;
            let camera = Camera {
                eye: from + along * Vec3::new(-5.0, -2.0, -4.0),
                target: Vec3::new(3.0 * along, 0.5, 0.0),
                ..field.scene.camera
            };
            let frame = Frame::new(vec![sun(toward, cascades)], camera);
            match step % 3 == 2 {
                true => frame,
                false => frame.passing(),
            }
        };
        // Once all are drawn.
        let first = (0..4).map(|_| frame(0));
        Frames {
            atlas: ShadowAtlasDescriptor {
                max_tiles_per_frame: Some(1),
                ..Default::default()
            },
            came_about: Some(("waiting", |of| of.tiles_postponed > 0)),
            ..frames(
                name,
                field.scene.clone(),
                first.chain((0..12).map(frame)).collect(),
            )
        }
    });
    all.into()
}

fn two_views(random: &mut Random) -> Vec<Frames> {
    let field = field(random);
    // From above, so that neither sees what is farther away than its cascades reach.
    let mut above = |x: f32, z: f32| Camera {
        eye: Vec3::new(x, 9.0, z + 4.0) + random.point(0.5),
        target: Vec3::new(x, 0.0, z),
        ..field.scene.camera
    };
    let (usual, other) = (above(0.0, 0.0), above(-22.0, 18.0));
    let orthographic = Look {
        depth: DepthConvention::FiniteReverse,
        orthographic: Some(Orthographic {
            left: -6.0,
            right: 6.0,
            bottom: -4.5,
            top: 4.5,
            near: 0.1,
            far: 40.0,
        }),
        ..Look::default()
    };
    let others = [Look::default(), orthographic].map(|look| Seen {
        look,
        ..Seen::by(other)
    });
    let names = ["both in perspective", "one orthographic"];
    names
        .into_iter()
        .zip(others)
        .map(|(what, second)| {
            let sun = sun(toward_sun(random), four(20.0));
            let lamps = [LightKind::Point, LightKind::Spot];
            let lamps = lamps.map(|kind| Lamp::fixed(light(kind, random), SIDE));
            let mut lights = lamps.to_vec();
            lights.insert(1, sun);
            let frame = Frame {
                views: vec![Seen::by(usual), second],
                ..Frame::new(lights, usual)
            };
            frames(what, field.scene.clone(), vec![frame])
        })
        .collect()
}
