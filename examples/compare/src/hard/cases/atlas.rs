//! Cases of many lights in one atlas.

use shadows::glam::{Affine3A, Vec3, Vec4};
use shadows::{Cascades, ShadowAtlasDescriptor, TileSize};

use super::views::NEAR_EDGE;
use super::{Case, Expect};
use crate::hard::SIZE;
use crate::hard::atlas::{Frame, Frames, Lamp};
use crate::hard::situation::{Situation, at};
use host::random::Random;
use host::scene::{Camera, Cone, Light, LightKind, Scene};
use host::shapes;

/// Each pixel counts once for each light and frame, and so does one whose surface the rasteriser takes for another.
const MANY_LIGHTS: Case = Case {
    maps: Expect::Rare(NEAR_EDGE),
    ..Case::EXACT
};

pub const CASES: [Case; 4] = [
    Case {
        name: "Tiles beside foreign ones",
        build: "two dozen lights of all kinds, every third in a closed box that leaves it dark, tiles of 16 to 1024 texels, and all of 16",
        answer: "each light's picture is its own",
        frames: Some(neighbours),
        ..MANY_LIGHTS
    },
    Case {
        name: "Memory runs short",
        build: "20 lamps and spots and two suns in two layers of 512 texels, a camera that goes from one to the other, lights that go and come back, casters that move meanwhile",
        answer: "smaller tiles; none foreign, stale or missing",
        frames: Some(short),
        ..MANY_LIGHTS
    },
    Case {
        name: "A light becomes another kind",
        build: "lights that are points, spots and suns by turns, change places in the list and turn from one frame to the next",
        answer: "as a fresh atlas: equals the reference",
        frames: Some(other_kinds),
        ..MANY_LIGHTS
    },
    Case {
        name: "Casters move under a budget",
        build: "six lamps, spots and a sun, three tiles a frame, casters that move for ten frames and then rest",
        answer: "at rest: equals the reference",
        frames: Some(at_rest),
        ..MANY_LIGHTS
    },
];

/// Frames that a budget needs to draw all that changed: tiles of all lights over tiles a frame, and one.
const REST: usize = 10;

/// A ground with things that stand apart.
pub(super) fn yard(random: &mut Random) -> Situation {
    let shapes = [shapes::cube().tilted(), shapes::sphere(10), shapes::fins(3)];
    let mut yard = Situation::new("", Vec4::Y, random);
    for n in 0..9_u16 {
        let (x, z) = (f32::from(n % 3) * 3.0 - 3.0, f32::from(n / 3) * 3.0 - 3.0);
        let place = at(x, 1.0, z) * Affine3A::from_scale(Vec3::splat(0.45));
        yard = yard.caster(&shapes[usize::from(n) % 3], place);
    }
    // The ground fills the picture.
    let eye = Vec3::new(1.0, 7.0, 7.0) + random.point(0.5);
    yard.camera(eye, Vec3::new(0.0, 0.0, -0.5))
}

/// Frames of the yard, or of what else it has become.
pub(super) fn frames(what: impl Into<String>, scene: Scene, frames: Vec<Frame>) -> Frames {
    Frames {
        what: what.into(),
        scene,
        atlas: ShadowAtlasDescriptor::default(),
        size: SIZE,
        frames,
        came_about: None,
    }
}

/// A light of that kind, above the yard.
pub(super) fn light(kind: LightKind, random: &mut Random) -> Light {
    let place = Vec3::new(0.0, 4.0, 0.0) + random.point(1.0) * Vec3::new(4.0, 1.0, 4.0);
    match kind {
        LightKind::Point => Light::new(place.extend(1.0), 14.0),
        LightKind::Spot => Light {
            cone: Some(Cone {
                direction: random.point(2.0) * Vec3::new(1.0, 0.0, 1.0) - place,
                half_angle: random.within(0.4, 1.0),
            }),
            ..Light::new(place.extend(1.0), 20.0)
        },
        LightKind::Directional => {
            let toward = Vec3::new(0.0, 1.0, 0.0) + random.point(0.6) * Vec3::new(1.0, 0.2, 1.0);
            Light::new(toward.extend(0.0), 100.0)
        }
    }
}

const KINDS: [LightKind; 3] = [LightKind::Point, LightKind::Spot, LightKind::Directional];

fn neighbours(random: &mut Random) -> Vec<Frames> {
    let mixed: &[u32] = &[16, 1024, 32, 256, 64, 512, 128];
    [("16 to 1024 texels", mixed), ("16 texels", &[16])]
        .into_iter()
        .map(|(what, sizes)| {
            let mut yard = yard(random);
            let mut lights = Vec::new();
            for number in 0..24 {
                let kind = match number % 3 {
                    1 if number % 2 == 0 => LightKind::Directional,
                    1 | 2 => LightKind::Spot,
                    _ => LightKind::Point,
                };
                let light = light(kind, random);
                if number % 3 == 0 || number % 6 == 5 {
                    // All that its tiles hold is near, and beside them lie others' that are far.
                    if number % 2 == 1 {
                        let place = Affine3A::from_translation(light.place.truncate());
                        let small = Affine3A::from_scale(Vec3::splat(0.1));
                        yard = yard.caster(&shapes::cube(), place * small);
                    }
                }
                let size = sizes[number % sizes.len()];
                lights.push(lamp_of(light, size));
            }
            let camera = yard.scene.camera;
            frames(what, yard.scene, vec![Frame::new(lights, camera)])
        })
        .collect()
}

/// With tiles of that size, as far as its kind has such: kernels of 12 texels need cascades of 64, and the six
/// tiles of a point light fill an atlas.
fn lamp_of(light: Light, size: u32) -> Lamp {
    let (least, most) = match light.kind() {
        LightKind::Point => (16, 256),
        LightKind::Spot => (16, 1024),
        LightKind::Directional => (64, 512),
    };
    Lamp {
        cascades: Cascades {
            count: 2,
            distance: 60.0,
            ..Default::default()
        },
        ..Lamp::fixed(light, size.clamp(least, most))
    }
}

fn short(random: &mut Random) -> Vec<Frames> {
    let yard = yard(random);
    let mut all: Vec<Lamp> = (0..20)
        .map(|number| Lamp {
            size: TileSize::Auto {
                least: 16,
                most: 256,
            },
            ..Lamp::fixed(light(KINDS[number % 2], random), 16)
        })
        .collect();
    for place in [5, 12] {
        let sun = lamp_of(light(LightKind::Directional, random), 64);
        let size = TileSize::Auto {
            least: 64,
            most: 256,
        };
        all.insert(place, Lamp { size, ..sun });
    }
    let without = |left_out: std::ops::Range<usize>| {
        let kept = all.iter().enumerate();
        let kept = kept.filter(|(number, _)| !left_out.contains(number));
        kept.map(|(_, lamp)| *lamp).collect::<Vec<_>>()
    };
    let mut near = |around: f32| Camera {
        eye: Vec3::new(3.0 * around, 2.5, 4.5) + random.point(0.5),
        target: Vec3::new(-around, 0.5, 0.0),
        ..yard.scene.camera
    };
    let of_all = yard.scene.camera;
    let course = vec![
        Frame::new(all.clone(), of_all),
        moved(Frame::new(without(0..6), near(1.0)), 0.4),
        moved(Frame::new(without(0..6), near(1.5)), 0.8),
        Frame::new(without(4..7), near(-1.0)),
        moved(Frame::new(without(4..7), near(-1.0)), -0.5),
        moved(
            Frame::new(all.iter().rev().copied().collect(), near(2.0)),
            -1.0,
        ),
        Frame::new(all.clone(), of_all),
    ];
    vec![Frames {
        atlas: ShadowAtlasDescriptor {
            layer_size: 512,
            memory: 2 * 4 * 512 * 512,
            ..Default::default()
        },
        came_about: Some(("halved tiles", |of| of.lights_reduced > 5)),
        ..frames("two layers of 512", yard.scene, course)
    }]
}

/// With casters aside, to be seen no more than by what it leaves.
fn moved(frame: Frame, aside: f32) -> Frame {
    Frame {
        moved: Vec3::new(aside, 0.05 * aside, 0.5),
        ..frame.passing()
    }
}

fn other_kinds(random: &mut Random) -> Vec<Frames> {
    let yard = yard(random);
    let camera = yard.scene.camera;
    let mut course = Vec::new();
    for turn in 0..4 {
        let lights = (0..5).map(|number| {
            let kind = KINDS[(number + turn) % 3];
            lamp_of(light(kind, random), 256)
        });
        let mut lights: Vec<Lamp> = lights.collect();
        if turn == 2 {
            // Nothing but its direction or its place in the list is new.
            let before: &Frame = &course[1];
            lights.clone_from(&before.lights);
            lights.rotate_left(2);
            for lamp in &mut lights {
                if let Some(cone) = &mut lamp.light.cone {
                    cone.direction += random.point(0.5);
                }
            }
        }
        course.push(Frame::new(lights, camera));
    }
    vec![frames("four frames", yard.scene, course)]
}

fn at_rest(random: &mut Random) -> Vec<Frames> {
    let yard = yard(random);
    let camera = yard.scene.camera;
    let mut lights: Vec<Lamp> = (0..6)
        .map(|number| lamp_of(light(KINDS[number % 2], random), 256))
        .collect();
    lights.push(lamp_of(light(LightKind::Directional, random), 256));
    let moving = (0..10).map(|step| {
        let frame = Frame::new(lights.clone(), camera);
        moved(frame, 0.3 * step as f32 - 2.0)
    });
    let resting = (0..REST).map(|_| Frame::new(lights.clone(), camera).passing());
    let mut course: Vec<Frame> = moving.chain(resting).collect();
    course.push(Frame::new(lights.clone(), camera));
    vec![Frames {
        atlas: ShadowAtlasDescriptor {
            max_tiles_per_frame: Some(3),
            ..Default::default()
        },
        came_about: Some(("rest", |of| {
            of.tiles_postponed == 0 && of.tiles_rendered == 0
        })),
        ..frames("three tiles a frame", yard.scene, course)
    }]
}
