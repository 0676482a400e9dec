//! Which light is baked: rectangles, cones, ranges, the side that is turned to it.

use glam::{Affine3A, DAffine3, DVec3, Quat, Vec3};
use shadows::reference::ReferenceScene;
use shadows::reference::bake::{
    BakeDescriptor, BakedLight, Emitter, LightMap, LightMapLayout, LightMapReceiver, TexelRectangle,
};
use shadows::{DirectionalLight, PointLight, SpotLight, glam};

use super::yard::{Unwrapped, square};

const TEXELS: u32 = 64;

/// A ground of 4 by 4, a texel 1/16 wide; u along x.
fn ground() -> Unwrapped {
    Unwrapped::new(&square(2.0, Affine3A::IDENTITY), TEXELS, 0.0)
}

fn layout(change: impl FnOnce(&mut LightMapReceiver<'_>)) -> LightMapLayout {
    let ground = ground();
    let mut receiver = ground.receiver(TexelRectangle {
        x: 0,
        y: 0,
        width: TEXELS,
        height: TEXELS,
    });
    change(&mut receiver);
    LightMapLayout::new([TEXELS; 2], &[receiver]).unwrap()
}

fn bake(scene: &ReferenceScene, light: &BakedLight) -> LightMap {
    let descriptor = BakeDescriptor {
        samples: 256,
        margin: 0,
    };
    scene.bake(&layout(|_| ()), light, &descriptor).unwrap()
}

/// Half-way up to the light, over all x above 0.
fn roof() -> ReferenceScene {
    let roof = Affine3A::from_translation(Vec3::new(8.0, 2.0, 0.0));
    let roof = Unwrapped::new(&square(8.0, roof), TEXELS, 0.0);
    ReferenceScene::new(&[roof.object(true)]).unwrap()
}

#[test]
fn the_penumbra_of_a_rectangle_is_a_ramp() {
    let half_sides = [Vec3::X * 0.5, Vec3::Z * 0.25];
    let lamp = BakedLight::new(PointLight::new(Vec3::Y * 4.0, 20.0));
    let map = bake(
        &roof(),
        &lamp.with_emitter(Emitter::Rectangle { half_sides }),
    );
    let worst = |half: f64| {
        (0..TEXELS)
            .map(|x| {
                // What is left of the light past the roof's edge, seen from x, ends at -x.
                let at = (f64::from(x) + 0.5) / 16.0 - 2.0;
                let expected = (0.5 - 0.5 * at / half).clamp(0.0, 1.0);
                let seen = map.visibility()[(20 * TEXELS + x) as usize];
                (f64::from(seen) - expected).abs()
            })
            .fold(0.0, f64::max)
    };
    assert!(worst(0.5) < 0.02, "{}", worst(0.5));
    // The twin: a light of another width.
    assert!(worst(0.4) > 0.05, "{}", worst(0.4));
}

#[test]
fn a_ball_and_a_suns_disk_are_segments_of_a_disk() {
    // The edge is at 2 of 4: places on the light beyond it are seen from as far on the other side.
    let of_ball = bake(
        &roof(),
        &BakedLight::new(PointLight::new(Vec3::Y * 4.0, 20.0))
            .with_emitter(Emitter::Sphere { radius: 0.5 }),
    );
    // A sun is infinitely far, so the penumbra is 2 m times its tangent wide to each side.
    let of_sun = bake(
        &roof(),
        &BakedLight::new(DirectionalLight::new(Vec3::Y))
            .with_emitter(Emitter::Sphere { radius: 0.25 }),
    );
    let worst = |map: &LightMap, radius: f64| {
        (16..48)
            .map(|x| {
                let at = (f64::from(x) + 0.5) / 16.0 - 2.0;
                let t = (-at / radius).clamp(-1.0, 1.0);
                let hidden = (t.acos() - t * (1.0 - t * t).sqrt()) / std::f64::consts::PI;
                let seen = map.visibility()[(32 * TEXELS + x) as usize];
                (f64::from(seen) - (1.0 - hidden)).abs()
            })
            .fold(0.0, f64::max)
    };
    assert!(worst(&of_ball, 0.5) < 0.03, "{}", worst(&of_ball, 0.5));
    assert!(worst(&of_sun, 0.5) < 0.03, "{}", worst(&of_sun, 0.5));
    assert!(worst(&of_ball, 0.4) > 0.05 && worst(&of_sun, 0.4) > 0.05);
}

#[test]
fn there_is_nothing_outside_a_cone_or_beyond_a_range() {
    let empty = ReferenceScene::new(&[]).unwrap();
    let spot = SpotLight::new(Vec3::Y * 2.0, Vec3::NEG_Y, 0.5, 20.0);
    let lamp = PointLight::new(Vec3::Y * 2.0, 2.0 / 0.5_f32.cos());
    // Both light the disk of radius 2 tan(0.5).
    for light in [BakedLight::new(spot), BakedLight::new(lamp)] {
        let map = bake(&empty, &light);
        let disk = |radius: f64| {
            (0..TEXELS * TEXELS).filter(move |place| {
                let at =
                    [place % TEXELS, place / TEXELS].map(|at| (f64::from(at) + 0.5) / 16.0 - 2.0);
                at[0].hypot(at[1]) < radius
            })
        };
        let wrong = |radius: f64| {
            let outside =
                disk(2.9).filter(|place| !disk(radius + 0.05).any(|other| other == *place));
            let inside =
                disk(radius - 0.05).filter(|&place| map.visibility()[place as usize] != 1.0);
            inside.count()
                + outside
                    .filter(|&place| map.visibility()[place as usize] != 0.0)
                    .count()
        };
        let radius = 2.0 * 0.5_f64.tan();
        assert_eq!(wrong(radius), 0);
        assert!(wrong(radius + 0.3) > 50 && wrong(radius - 0.3) > 50);
    }
}

/// The front alone is baked, mirrored or not, unless both sides are asked for.
#[test]
fn a_side_is_chosen_by_the_mesh_not_by_its_transform() {
    let empty = ReferenceScene::new(&[]).unwrap();
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let turned = DAffine3::from_quat(Quat::from_rotation_x(3.0).as_dquat());
    let lit = |transform: DAffine3, two_sided: bool, light: Vec3| {
        let layout = layout(|receiver| {
            receiver.transform = transform;
            receiver.two_sided = two_sided;
        });
        let light = BakedLight::new(DirectionalLight::new(light));
        let map = empty
            .bake(&layout, &light, &BakeDescriptor::default())
            .unwrap();
        let all = map.visibility().iter().all(|value| *value == 1.0);
        let none = map.visibility().iter().all(|value| *value == 0.0);
        assert!(all || none);
        all
    };
    for (transform, up) in [(DAffine3::IDENTITY, Vec3::Y), (turned, Vec3::NEG_Y)] {
        for transform in [transform, mirror * transform] {
            assert!(lit(transform, false, up) && !lit(transform, false, -up));
            assert!(lit(transform, true, up) && lit(transform, true, -up));
        }
    }
}
